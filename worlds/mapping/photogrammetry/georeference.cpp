#include "worlds/mapping/photogrammetry/georeference.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/random.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector7d = Eigen::Matrix<double, 7, 1>;

/// Positions closer than this to one line (rms) leave the block's rotation about it undetermined.
constexpr double kMinSpread_m = 3.0;
/// Pictures flown at one height do: they spread in the plane.
constexpr int kFewestPlaces = 4;
/// Share of white noise in the variance of a post-processed position.
constexpr double kWhiteShare = 1.0 / 3.0;

/// Rms distance of the positions from their best line, in the plane.
double spread_m(const std::vector<KnownPlace>& places, const Vector3d& centre_W) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const KnownPlace& place : places) {
    const Vector2d arm = (place.true_W - centre_W).head<2>();
    scatter += arm * arm.transpose();
  }
  scatter /= static_cast<double>(places.size());
  const double mean = 0.5 * scatter.trace();
  const double half = std::hypot(0.5 * (scatter(0, 0) - scatter(1, 1)), scatter(0, 1));
  return std::sqrt(std::max(0.0, mean - half));
}

Vector3d draw(RandomStream& random, double plane_m, double height_m) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {plane_m * x, plane_m * y, height_m * z};
}

}  // namespace

const char* name_of(GeoreferenceOptions::Method method) {
  switch (method) {
    case GeoreferenceOptions::Method::kDirect:
      return "direct";
    case GeoreferenceOptions::Method::kPpk:
      return "ppk";
    case GeoreferenceOptions::Method::kControlPoints:
      return "control_points";
    case GeoreferenceOptions::Method::kTruth:
      return "truth";
  }
  return "?";
}

const ParameterTable<GeoreferenceOptions>& georeference_table() {
  using P = GeoreferenceOptions;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("georeference", &P::method,
                  {{"direct", P::Method::kDirect},
                   {"ppk", P::Method::kPpk},
                   {"control_points", P::Method::kControlPoints},
                   {"truth", P::Method::kTruth}},
                  "source of the georeferencing: camera positions as the vehicle estimated them, "
                  "the same post-processed, marks on the ground, or the truth, for studies")
          .numbers("ppk_std_m", "m", &P::ppk_std_m, between(0.0, 10.0),
                   "1 sigma of a post-processed camera position: each axis of the plane, height")
          .integer("control_points", &P::control_points, between(4, 1000),
                   "marks on the ground, around the area and in its middle")
          .numbers("control_std_m", "m", &P::control_std_m, between(0.0, 10.0),
                   "1 sigma of a surveyed mark: each axis of the plane, height")
          .number("principal_distance_std", "", &P::principal_distance_std, between(0.0, 0.1),
                  "relative 1 sigma of the lens's principal distance, which scales heights without "
                  "control points");
  return table;
}

Result<Georeference> fit_georeference(const std::vector<KnownPlace>& places,
                                      const std::array<double, 2>& std_m) {
  if (places.size() < kFewestPlaces) {
    return Failure{fmt::format("{} positions are known, a block of pictures needs at least {}",
                               places.size(), kFewestPlaces)};
  }
  Georeference fit;
  for (const KnownPlace& place : places) fit.centre_W += place.true_W;
  fit.centre_W /= static_cast<double>(places.size());
  const double off_line_m = spread_m(places, fit.centre_W);
  if (off_line_m < kMinSpread_m) {
    return Failure{
        fmt::format("the known positions are {:.1f} m (rms) off one line, must be at least {} m: "
                    "they leave the block's rotation about it undetermined; fly another lane or "
                    "use georeference: control_points",
                    off_line_m, kMinSpread_m)};
  }
  // e = J x with x = (t, w, k); w x a = -[a]x w.
  Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
  Vector7d right = Vector7d::Zero();
  const double min_std_m = 1e-6;
  const Vector3d weights(1.0 / std::pow(std::max(std_m[0], min_std_m), 2),
                         1.0 / std::pow(std::max(std_m[0], min_std_m), 2),
                         1.0 / std::pow(std::max(std_m[1], min_std_m), 2));
  for (const KnownPlace& place : places) {
    const Vector3d a = place.true_W - fit.centre_W;
    Eigen::Matrix<double, 3, 7> J;
    J.leftCols<3>().setIdentity();
    J.middleCols<3>(3) << 0.0, a.z(), -a.y(), -a.z(), 0.0, a.x(), a.y(), -a.x(), 0.0;
    J.col(6) = a;
    const Eigen::Matrix<double, 7, 3> JtW = J.transpose() * weights.asDiagonal();
    normal += JtW * J;
    right += JtW * (place.estimated_W - place.true_W);
  }
  const Vector7d x = normal.ldlt().solve(right);
  fit.shift_m = x.head<3>();
  fit.turn_rad = x.segment<3>(3);
  fit.scale = x[6];
  return fit;
}

std::vector<Vector2d> control_places(const Eigen::AlignedBox2d& box, int count) {
  // The middle, and the others along the edge, from a corner on, evenly by its length.
  std::vector<Vector2d> places = {box.center()};
  const Vector2d size = box.sizes();
  const double around_m = 2.0 * size.sum();
  for (int k = 0; k + 1 < count; ++k) {
    // Four marks stand in the corners; more go between them.
    double at_m = around_m * k / (count - 1);
    if (count == 5) at_m = std::array{0.0, size.x(), size.sum(), size.sum() + size.x()}[k];
    Vector2d p = box.min();
    const double steps[4] = {size.x(), size.y(), size.x(), size.y()};
    const Vector2d directions[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int edge = 0; edge < 4; ++edge) {
      const double step_m = std::min(at_m, steps[edge]);
      p += step_m * directions[edge];
      at_m -= step_m;
    }
    places.push_back(p);
  }
  return places;
}

Result<Georeference> georeference(const GeoreferenceRequest& request,
                                  const GeoreferenceOptions& options) {
  using Method = GeoreferenceOptions::Method;
  const bool by_cameras = options.method == Method::kDirect || options.method == Method::kPpk;
  if (options.method == Method::kTruth) return Georeference{};
  if (options.method == Method::kDirect && request.estimated_W.empty()) return Georeference{};
  RandomStream random(request.seed, "cloud", "georeference");
  std::vector<KnownPlace> places;
  std::array<double, 2> std_m = options.control_std_m;
  if (options.method == Method::kDirect) {
    std_m = options.ppk_std_m;  // as weights: height against plane
    for (std::size_t i = 0; i < request.cameras_W.size(); ++i) {
      places.push_back({request.cameras_W[i], request.estimated_W[i]});
    }
  } else if (options.method == Method::kPpk) {
    std_m = options.ppk_std_m;
    const double slow = std::sqrt(1.0 - kWhiteShare), white = std::sqrt(kWhiteShare);
    const Vector3d common = draw(random, slow * std_m[0], slow * std_m[1]);
    for (const Vector3d& p_W : request.cameras_W) {
      places.push_back({p_W, p_W + common + draw(random, white * std_m[0], white * std_m[1])});
    }
  } else {
    for (const Vector3d& p_W : request.marks_W) {
      places.push_back({p_W, p_W + draw(random, std_m[0], std_m[1])});
    }
  }
  const Result<Georeference> fit = fit_georeference(places, std_m);
  if (!fit) return fit;
  Georeference found = *fit;
  if (by_cameras) found.height_scale = options.principal_distance_std * random.normal();
  return found;
}

}  // namespace vinerow::mapping
