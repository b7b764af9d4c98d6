#pragma once
/// Arc through three points, as in the paper's hairpins (paper B, section 2.3).

#include "controllers/parts/paths/pose2.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

struct Arc3 {
  Pose2 start;                   ///< first point and the direction of travel there
  double length_m = 0.0;         ///< from the first point through the second to the third
  double curvature_per_m = 0.0;  ///< positive to the left
  double radius_m() const { return 1.0 / std::abs(curvature_per_m); }
};

/// @returns the arc from `a` through `b` to `c`, or a failure if two points coincide or all three
/// are on a line (radius above a million times the chord)
Result<Arc3> make_arc3(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                       const Eigen::Vector2d& c);

}  // namespace vinerow::controllers
