#pragma once
/// Which alleys are driven, in which order, and the straights of each.

#include <vector>

#include "controllers/parts/paths/pose2.h"

namespace vinerow::controllers {

enum class AlleyOrder {
  kSerpentine,  ///< one after the other
  kSkip,        ///< never to the neighbour: even ones up, odd ones back, so that turns are wide
};

/// The places 0..count-1 in driving order. With kSkip neighbours follow each other only where there
/// are fewer than five.
std::vector<int> make_alley_order(int count, AlleyOrder order);

/// The centre line of an alley in the plane without vertices that lie within `tolerance_m` of the
/// straight between the ones kept (Douglas and Peucker, 1973), so that a surveyed line's noise does
/// not steer the vehicle.
std::vector<Eigen::Vector2d> simplify_line(const std::vector<Eigen::Vector3d>& line_W,
                                           double tolerance_m);

}  // namespace vinerow::controllers
