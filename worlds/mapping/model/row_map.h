#pragma once
/// From the lines of a block of rows to its row map: order, alleys, the parcel around them.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "engine/api/forward.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// Puts surveyed lines in order: all run the same way as the first, sorted across the block. The
/// line that comes first in the file stays on the side it is on: the order is turned if it would
/// otherwise be in the second half.
std::vector<RowCurve> order_rows(std::vector<RowCurve> rows);

/// The line midway between two rows that run the same way. Two straight rows give two points.
std::vector<Eigen::Vector2d> middle_line(const RowCurve& left, const RowCurve& right);

/// Corners of the box around the rows, turned with the mean row direction, counter-clockwise.
/// @param along_m,across_m  margins beyond the row ends and the outer rows
std::vector<Eigen::Vector2d> parcel_boundary(const std::vector<RowCurve>& rows, double along_m,
                                             double across_m);

/// Axis-aligned box around a polygon.
Eigen::AlignedBox2d box_around(const std::vector<Eigen::Vector2d>& polygon_W);

/// Of all rows alike.
struct CanopySize {
  double width_m = 0.55;
  double base_m = 0.55;  ///< lowest leaves above ground
  double top_m = 2.0;
};

/// Rows and inner alleys (one fewer than rows), lifted to the ground. @param rows  ordered
RowMap make_row_map(const std::vector<RowCurve>& rows, const GroundHeight& ground,
                    const CanopySize& canopy, std::vector<Eigen::Vector2d> boundary_W);

}  // namespace vinerow::mapping
