#pragma once
/// Where a thin disc that moves along its strut meets the ground.
///
/// Rays go down the strut's direction from several places along the disc. Each hit is taken as a
/// small plane. If the disc would touch that plane near the ray, the plane decides (exact on slopes
/// with a single ray); otherwise the hit is taken as a point, e.g. the edge of a step, and the
/// contact normal is the disc's own. The contact that pushes the hub highest wins.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

namespace vinerow::vehicles {

struct WheelContact {
  bool touches = false;
  double travel_m = 0.0;  ///< of the hub from its design position, positive up the strut
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();        ///< contact point
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< out of the ground, unit
};

/// The disc in its design position. x forward, y axle, z strut, all unit and orthogonal.
struct WheelDisc {
  Eigen::Vector3d hub_W;
  Eigen::Vector3d x_W, y_W, z_W;
  double radius_m;
  double droop_m;  ///< lowest travel, <= 0
  int probes;      ///< 1, 3 or 5 rays
};

/// Places of the rays along the disc, in radii.
constexpr std::array<double, 5> kProbeOffsets = {0.0, 0.6, -0.6, 0.85, -0.85};
/// The rays start this many radii above the design hub: a step up to there is seen.
constexpr double kProbeLift = 1.0;

/// @param probe  (p_W, dir_W, max_distance_m) -> optional of a struct with `distance_m`, `normal_W`
template <class Probe>
WheelContact find_wheel_contact(const WheelDisc& disc, Probe&& probe) {
  WheelContact best;
  best.travel_m = disc.droop_m;
  const double r = disc.radius_m;
  const Eigen::Vector3d down = -disc.z_W;
  for (int i = 0; i < disc.probes; ++i) {
    const double s = kProbeOffsets[static_cast<std::size_t>(i)] * r;
    const Eigen::Vector3d start = disc.hub_W + s * disc.x_W + (kProbeLift * r) * disc.z_W;
    const auto hit = probe(start, down, (1.0 + kProbeLift) * r - disc.droop_m);
    if (!hit) continue;
    const Eigen::Vector3d& n = hit->normal_W;
    // Height of the hit above the design hub, along the strut, at offset s.
    const double height = kProbeLift * r - hit->distance_m;
    const double nx = disc.x_W.dot(n), nz = disc.z_W.dot(n);
    const double in_plane = std::hypot(nx, nz);
    if (nz < 0.1) continue;  // a wall: the body's own shape meets it

    // The disc touches the hit's plane at offset -r nx / |n_xz|, |n_xz| the part of n in the disc.
    const double touch_s = -r * nx / in_plane;
    const double half_gap = 0.3 * r;
    if (std::abs(touch_s - s) <= half_gap) {
      const double travel = height + (nx / nz) * s + r * in_plane / nz;
      if (travel > best.travel_m) {
        best.touches = true;
        best.travel_m = travel;
        best.normal_W = n;
        best.p_W =
            disc.hub_W + travel * disc.z_W - (r / in_plane) * (nx * disc.x_W + nz * disc.z_W);
      }
      continue;
    }
    const double rise = std::sqrt(r * r - s * s);
    const double travel = height + rise;
    if (travel > best.travel_m) {
      best.touches = true;
      best.travel_m = travel;
      best.normal_W = (rise * disc.z_W - s * disc.x_W) / r;
      best.p_W = disc.hub_W + s * disc.x_W + height * disc.z_W;
    }
  }
  return best;
}

}  // namespace vinerow::vehicles
