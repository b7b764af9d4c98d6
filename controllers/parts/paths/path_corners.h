#pragma once
/// Corners of a planned path: points where its direction jumps.

#include <vector>

#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Vehicles that can turn on the spot do so at larger jumps: 35 deg. A follower drives round
/// smaller ones within its lookahead distance.
inline constexpr double kSharpCorner_rad = 0.610865238198015;

struct PathCorner {
  int point = 0;          ///< index of the corner among the plan's points
  double turn_rad = 0.0;  ///< of the direction, positive to the left, in (-pi, pi]
};

/// Corners sharper than `min_rad`, in the path's order. A curved stretch counts as the arc of its
/// point's curvature, however coarse the waypoints: the chord of an arc has half its turn, so it
/// leaves with 2 * (direction of the chord) - (direction at its start).
std::vector<PathCorner> find_corners(const PlannedPath& plan, double min_rad);

}  // namespace vinerow::controllers
