#pragma once
/// Marks cells of an occupancy grid: areas by their centres, lines by touch.
///
/// Points are in W. What lies beyond the grid's edge is left out.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/api/messages/grid.h"

namespace vinerow::mapping {

/// A grid over a box and one more cell on every side. Its lines lie on whole multiples of the cell,
/// so that boxes that differ by little give cells in the same places.
/// @param value  of every cell
OccupancyGrid make_grid_over(const Eigen::AlignedBox2d& box_W, double cell_m, std::uint8_t value);

/// How many cells make_grid_over() makes.
double cell_count(const Eigen::AlignedBox2d& box_W, double cell_m);

/// Sets the cells whose centre is inside a polygon (even-odd rule), by scan lines: area is neither
/// gained nor lost on average. @param polygon_W  >= 3 vertices, either orientation, closed by
/// itself
void fill_polygon(OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& polygon_W,
                  std::uint8_t value);

/// Sets every cell that the segment touches, corners included (supercover): neither a step over an
/// edge nor one over a corner leads across the line.
void mark_segment(OccupancyGrid& grid, const Eigen::Vector2d& a_W, const Eigen::Vector2d& b_W,
                  std::uint8_t value);

}  // namespace vinerow::mapping
