#pragma once
/// Rasterisation into an occupancy grid: areas by cell centres, lines by touched cells.
///
/// Points are in W. Anything beyond the edge of the grid is ignored.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/api/messages/grid.h"

namespace vinerow::mapping {

/// Grid over a box and one more cell on every side. Its lines are at whole multiples of the cell,
/// so that similar boxes give cells in the same places.
/// @param value  of every cell
OccupancyGrid make_grid_over(const Eigen::AlignedBox2d& box_W, double cell_m, std::uint8_t value);

/// Number of cells of make_grid_over().
double cell_count(const Eigen::AlignedBox2d& box_W, double cell_m);

/// Sets the cells whose centre is inside a polygon (even-odd rule), by scan lines. The area is
/// unbiased. @param polygon_W  >= 3 vertices, either orientation, closed implicitly
void fill_polygon(OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& polygon_W,
                  std::uint8_t value);

/// Sets every cell that the segment touches, including corners (supercover): no path over cell
/// edges or corners crosses the line.
void mark_segment(OccupancyGrid& grid, const Eigen::Vector2d& a_W, const Eigen::Vector2d& b_W,
                  std::uint8_t value);

}  // namespace vinerow::mapping
