#pragma once
/// Where a thin disc that moves along its strut meets the ground.
///
/// The ground under the disc is described by planes over stretches of the disc's length: one ray
/// down the strut at the hub, one near the front and one near the rear of the disc. Where the outer
/// hit lies on the hub's plane, that plane holds all the way (exact on slopes). Where it does not,
/// the place of the change is found: the two planes' intersection if the ground has a kink there,
/// else by bisection (a step's edge). Of all stretches the one that lifts the hub most carries the
/// wheel: on a plane the ground's normal counts, on an edge the disc's own.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

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
  int probes;      ///< rays on smooth ground: 1 (hub only) or 3
};

/// The outer rays' distance from the hub, in radii: a step of 0.56 radii is felt in time.
constexpr double kOuterProbe = 0.9;
/// The rays start this many radii above the design hub: a step up to there is seen.
constexpr double kProbeLift = 1.0;
/// Ground that departs less than this from the hub's plane, in radii, is taken as that plane.
constexpr double kPlaneTolerance = 0.015;
/// Halvings of a step's place: 0.9 r / 32 is 6 mm for a wheel of 0.2 m.
constexpr int kBisections = 5;

namespace internal {

/// Ground along the disc near one hit: height above the design hub over the offset s.
struct GroundLine {
  double s = 0.0, height = 0.0, slope = 0.0;
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  double at(double offset) const { return height + slope * (offset - s); }
};

/// The disc on `line` over the stretch [from, to]; keeps the higher of it and `best`.
inline void consider(const WheelDisc& disc, const GroundLine& line, double from, double to,
                     WheelContact& best) {
  const double r = disc.radius_m;
  // A disc of radius r rests on a line of slope m at s = -r n_x / |n_xz| = r m / sqrt(1 + m^2)
  // below its hub, n_xz the normal's part in the disc's plane.
  const double touch = r * line.slope / std::sqrt(1.0 + line.slope * line.slope);
  const double s = std::clamp(touch, from, to);
  const double rise = std::sqrt(r * r - s * s);
  const double travel = line.at(s) + rise;
  if (travel <= best.travel_m) return;
  best.touches = true;
  best.travel_m = travel;
  best.p_W = disc.hub_W + s * disc.x_W + line.at(s) * disc.z_W;
  best.normal_W = s == touch ? line.normal_W : (rise * disc.z_W - s * disc.x_W) / r;
}

}  // namespace internal

/// @param probe  (p_W, dir_W, max_distance_m) -> optional of a struct with `distance_m`, `normal_W`
template <class Probe>
WheelContact find_wheel_contact(const WheelDisc& disc, Probe&& probe) {
  using internal::GroundLine;
  const double r = disc.radius_m;
  const double reach = (1.0 + kProbeLift) * r - disc.droop_m;
  // Ground below offset s. Missing ground counts as far below; a wall is the body's own affair.
  const auto look = [&](double s, GroundLine& line) {
    const auto hit = probe(Eigen::Vector3d(disc.hub_W + s * disc.x_W + (kProbeLift * r) * disc.z_W),
                           Eigen::Vector3d(-disc.z_W), reach);
    line.s = s;
    line.height = kProbeLift * r - reach;
    line.slope = 0.0;
    if (!hit) return false;
    const double nz = disc.z_W.dot(hit->normal_W);
    if (nz < 0.1) return false;
    line.height = kProbeLift * r - hit->distance_m;
    line.slope = -disc.x_W.dot(hit->normal_W) / nz;
    line.normal_W = hit->normal_W;
    return true;
  };

  WheelContact best;
  best.travel_m = disc.droop_m;
  GroundLine hub;
  const bool hub_hit = look(0.0, hub);
  double reach_of_hub[2] = {kOuterProbe * r, kOuterProbe * r};  // ahead, behind
  for (int side = 0; side < 2 && disc.probes > 1; ++side) {
    const double sign = side == 0 ? 1.0 : -1.0;
    GroundLine outer;
    const bool outer_hit = look(sign * kOuterProbe * r, outer);
    const double tolerance = kPlaneTolerance * r;
    if (std::abs(outer.height - hub.at(outer.s)) <= tolerance) continue;

    // The change lies between low_s (hub's side) and high (outer side), distances from the hub.
    double low = 0.0, high = kOuterProbe * r;
    const double bend = hub.slope - outer.slope;
    const double kink = std::abs(bend) > 1e-9 ? sign * (outer.at(0.0) - hub.height) / bend : -1.0;
    GroundLine middle;
    if (hub_hit && outer_hit && kink > 0.0 && kink < high) {
      look(sign * kink, middle);
      if (std::abs(middle.height - hub.at(middle.s)) <= tolerance) low = high = kink;
    }
    for (int i = 0; i < kBisections && low < high; ++i) {
      const double at = 0.5 * (low + high);
      const bool hit = look(sign * at, middle);
      const double to_hub = std::abs(middle.height - hub.at(middle.s));
      const double to_outer = std::abs(middle.height - outer.at(middle.s));
      if (to_hub <= to_outer) {
        low = at;
      } else {
        high = at;
        if (hit) outer = middle;
      }
    }
    reach_of_hub[side] = low;
    if (!outer_hit) continue;
    const double near = sign * high, far = sign * kOuterProbe * r;
    internal::consider(disc, outer, std::min(near, far), std::max(near, far), best);
  }
  if (hub_hit) internal::consider(disc, hub, -reach_of_hub[1], reach_of_hub[0], best);
  return best;
}

}  // namespace vinerow::vehicles
