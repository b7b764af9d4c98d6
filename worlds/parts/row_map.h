#pragma once
/// Rows, the alleys between them, the parcel around them.

#include <vector>

#include "engine/api/forward.h"
#include "worlds/parts/canopy.h"
#include "worlds/parts/row_curve.h"

namespace vinerow::worlds {

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

/// Rows and inner alleys (one fewer than rows), lifted to the ground. @param rows  ordered
RowMap make_row_map(const std::vector<RowCurve>& rows, const GroundHeight& ground,
                    const CanopyParams& canopy, std::vector<Eigen::Vector2d> boundary_W);

/// "alley_<k>_start" and "alley_<k>_end", both on the alley's end points, looking into the alley.
void add_alley_spawn_points(WorldModel& world);

}  // namespace vinerow::worlds
