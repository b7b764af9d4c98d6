#pragma once
/// Point clouds of parcels that are known in closed form: what row detection is judged by.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/random.h"
#include "worlds/mapping/model/parcel_cloud.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::test {

/// Rows with canopy of elliptic cross-section on a plane or a wavy hillside.
struct SyntheticParcel {
  int rows = 6;
  double length_m = 60.0;
  double spacing_m = 2.5;
  double angle_deg = 23.0;  ///< of the rows from x, counter-clockwise
  double radius_m = 0.0;    ///< of the first row's arc; 0: straight
  double vine_m = 1.0;      ///< between vines
  double missing = 0.0;     ///< share of vines, never the first or last of a row
  double width_m = 0.6, base_m = 0.5, top_m = 2.0;
  double slope_x = 0.0, slope_y = 0.0;
  double wave_m = 0.0;   ///< height of waves of 40 m
  double weeds_m = 0.0;  ///< height of tufts between the rows
  double noise_m = 0.02;
  double outliers = 0.0;  ///< share of points anywhere from 2 m below to 4 m above the ground
  double density_per_m2 = 200.0;  ///< seen from above; canopy sides get as many per own area
  double margin_m = 6.0;
  Eigen::Vector3d middle_W = {1000.0, -500.0, 240.0};
  std::uint64_t seed = 1;

  double ground_m(double x, double y) const {
    const double u = x - middle_W.x(), v = y - middle_W.y();
    return middle_W.z() + slope_x * u + slope_y * v +
           wave_m * std::sin(2.0 * M_PI * u / 40.0) * std::cos(2.0 * M_PI * v / 40.0);
  }
  /// Place at `s_m` along row k, `y_m` to its left.
  Eigen::Vector2d place_W(int k, double s_m, double y_m) const {
    const double across = (k - 0.5 * (rows - 1)) * spacing_m + y_m, along = s_m - 0.5 * length_m;
    Eigen::Vector2d local(along, across);
    if (radius_m > 0.0) {
      // Arcs about one middle: rows further to the left have the smaller radius.
      const double r = radius_m - across,
                   turn = along / (radius_m - (k - 0.5 * (rows - 1)) * spacing_m);
      local = {r * std::sin(turn), radius_m - r * std::cos(turn)};
    }
    const double c = std::cos(angle_deg * M_PI / 180.0), s = std::sin(angle_deg * M_PI / 180.0);
    return middle_W.head<2>() +
           Eigen::Vector2d(c * local.x() - s * local.y(), s * local.x() + c * local.y());
  }
};

struct SyntheticCloud {
  mapping::ParcelCloud cloud;
  int missing_vines = 0;
};

inline SyntheticCloud make_synthetic_cloud(const SyntheticParcel& parcel) {
  RandomStream random(parcel.seed, "", "synthetic_parcel");
  SyntheticCloud made;
  mapping::ParcelCloud& cloud = made.cloud;
  cloud.origin_W = {std::round(parcel.middle_W.x()), std::round(parcel.middle_W.y()),
                    std::round(parcel.middle_W.z())};
  const auto add = [&](const Eigen::Vector2d& p, double height_m) {
    const double ground = parcel.ground_m(p.x(), p.y());
    Eigen::Vector3d q(p.x() + parcel.noise_m * random.normal(),
                      p.y() + parcel.noise_m * random.normal(),
                      ground + height_m + parcel.noise_m * random.normal());
    if (parcel.outliers > 0.0 && random.uniform(0.0, 1.0) < parcel.outliers) {
      q.z() = ground + random.uniform(-2.0, 4.0);
    }
    cloud.points.push_back((q - cloud.origin_W).cast<float>());
  };
  const double half_width = 0.5 * parcel.width_m,
               half_height = 0.5 * (parcel.top_m - parcel.base_m);
  const double middle_m = 0.5 * (parcel.top_m + parcel.base_m);
  std::vector<std::vector<bool>> stands(static_cast<std::size_t>(parcel.rows));
  const int vines = static_cast<int>(parcel.length_m / parcel.vine_m);
  for (auto& row : stands) {
    for (int v = 0; v < vines; ++v) {
      const bool is_end = v == 0 || v == vines - 1;
      row.push_back(is_end || random.uniform(0.0, 1.0) >= parcel.missing);
      made.missing_vines += row.back() ? 0 : 1;
    }
  }
  const auto is_vine = [&](int k, double s_m) {
    const int v = static_cast<int>(std::floor(s_m / parcel.vine_m));
    return v >= 0 && v < vines && stands[static_cast<std::size_t>(k)][static_cast<std::size_t>(v)];
  };
  // Ground and weeds between the rows; below a canopy nothing is seen.
  const double across_m = 0.5 * parcel.rows * parcel.spacing_m + parcel.margin_m;
  const double along_m = parcel.length_m + 2.0 * parcel.margin_m;
  const auto ground_points = static_cast<long>(2.0 * across_m * along_m * parcel.density_per_m2);
  for (long n = 0; n < ground_points; ++n) {
    const double s_m = random.uniform(-parcel.margin_m, parcel.length_m + parcel.margin_m);
    const double y_m = random.uniform(-across_m, across_m);
    const double row = y_m / parcel.spacing_m + 0.5 * (parcel.rows - 1);
    const int k = std::min(parcel.rows - 1, std::max(0, static_cast<int>(std::lround(row))));
    const double off_m = (row - k) * parcel.spacing_m;
    if (std::abs(off_m) < half_width && is_vine(k, s_m)) continue;
    double height_m = 0.0;
    if (parcel.weeds_m > 0.0 && std::abs(off_m) > 0.5) {
      height_m =
          parcel.weeds_m * std::pow(std::abs(std::sin(1.7 * s_m) * std::sin(2.3 * y_m + s_m)), 2.0);
    }
    add(parcel.place_W(k, s_m, off_m), height_m);
  }
  // Canopy: the upper three quarters of the ellipse.
  const double around_m =
      0.75 * M_PI *
      (3.0 * (half_width + half_height) -
       std::sqrt((3.0 * half_width + half_height) * (half_width + 3.0 * half_height)));
  const auto canopy_points = static_cast<long>(around_m * parcel.length_m * parcel.density_per_m2);
  for (int k = 0; k < parcel.rows; ++k) {
    for (long n = 0; n < canopy_points; ++n) {
      const double s_m = random.uniform(0.0, vines * parcel.vine_m);
      const double turn = random.uniform(-0.25 * M_PI, 1.25 * M_PI);
      if (!is_vine(k, s_m)) continue;
      add(parcel.place_W(k, s_m, half_width * std::cos(turn)),
          middle_m + half_height * std::sin(turn));
    }
  }
  return made;
}

}  // namespace vinerow::test
