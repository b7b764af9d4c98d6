#pragma once
/// Corners of a planned path: points where its direction jumps.

#include <vector>

#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Jumps by more than that are turned on the spot by vehicles that can: 35 deg. What is less a
/// follower drives round by itself, within its lookahead distance.
inline constexpr double kSharpCorner_rad = 0.610865238198015;

struct PathCorner {
  int point = 0;          ///< index of the corner among the plan's points
  double turn_rad = 0.0;  ///< of the direction, positive to the left, in (-pi, pi]
};

/// Corners sharper than `least_rad`, in the path's order. A bent stretch is taken for the arc that
/// its point tells, however coarse the waypoints: an arc's chord halves its turn, so it leaves with
/// 2 * (direction of the chord) - (direction at its start).
std::vector<PathCorner> find_corners(const PlannedPath& plan, double least_rad);

}  // namespace vinerow::controllers
