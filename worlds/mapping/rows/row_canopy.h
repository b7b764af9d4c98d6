#pragma once
/// Canopy points of one plant row, in the row's own frame.

#include <Eigen/Core>
#include <vector>

#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// Row as the detection passes it to the meshing.
struct RowCanopy {
  int row = 0;
  RowCurve line;  ///< horizontal, from the canopy's first point to its last
  /// (s, y, z) in m: along the line (may be a little below 0 or above its length), to the left of
  /// it, above the ground on the line at s.
  std::vector<Eigen::Vector3f> points;
};

}  // namespace vinerow::mapping
