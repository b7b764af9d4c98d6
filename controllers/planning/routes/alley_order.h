#pragma once
/// Order of the alleys of a route, and simplification of their centre lines.

#include <vector>

#include "controllers/parts/paths/pose2.h"

namespace vinerow::controllers {

enum class AlleyOrder {
  kSerpentine,  ///< one after the other
  kSkip,  ///< never to the neighbour: even alleys in ascending order, odd ones back, so that turns
          ///< are wide
};

/// The numbers 0..count-1 in driving order. With kSkip, neighbours follow each other only if there
/// are fewer than five.
std::vector<int> make_alley_order(int count, AlleyOrder order);

/// Centre line of an alley in the plane, without vertices within `tolerance_m` of the straight
/// between the remaining ones (Douglas and Peucker, 1973), so that the noise of a surveyed line
/// does not steer the vehicle.
std::vector<Eigen::Vector2d> simplify_line(const std::vector<Eigen::Vector3d>& line_W,
                                           double tolerance_m);

}  // namespace vinerow::controllers
