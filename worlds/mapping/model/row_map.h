#pragma once
/// Row map from the lines of a block: order of rows, alleys, and the parcel around them.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "engine/api/forward.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// Orders surveyed lines: all have the direction of the first and are sorted across the block. The
/// order is reversed if the line that comes first in the file would otherwise be in the second
/// half.
std::vector<RowCurve> order_rows(std::vector<RowCurve> rows);

/// Line midway between two rows of the same direction. Two straight rows give two points.
std::vector<Eigen::Vector2d> middle_line(const RowCurve& left, const RowCurve& right);

/// Corners of the box around the rows, aligned with the mean row direction, counter-clockwise.
/// @param along_m,across_m  margins beyond the row ends and the outer rows
std::vector<Eigen::Vector2d> parcel_boundary(const std::vector<RowCurve>& rows, double along_m,
                                             double across_m);

/// Axis-aligned box around a polygon.
Eigen::AlignedBox2d box_around(const std::vector<Eigen::Vector2d>& polygon_W);

/// Canopy of all rows.
struct CanopySize {
  double width_m = 0.55;
  double base_m = 0.55;  ///< lowest leaves above ground
  double top_m = 2.0;
};

/// Rows and inner alleys (one fewer than rows), lifted to the ground. @param rows  ordered
RowMap make_row_map(const std::vector<RowCurve>& rows, const GroundHeight& ground,
                    const CanopySize& canopy, std::vector<Eigen::Vector2d> boundary_W);

}  // namespace vinerow::mapping
