#pragma once
/// True canopy of a world as triangles by row, and the volume it encloses.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::mapping {

using CanopyTriangle = std::array<Eigen::Vector3d, 3>;  ///< in W, counter-clockwise from outside

/// Canopy that rays meet (class kCanopy, collides), by row of world.rows. A connected piece of a
/// mesh belongs to the row whose line is nearest to the mean of its vertices, if the distance is at
/// most `reach_m`.
/// @returns one list for every row, in their order
std::vector<std::vector<CanopyTriangle>> canopy_by_row(const WorldModel& world,
                                                       double reach_m = 3.0);

/// Volume of the union of closed meshes: lines across the direction, one in the middle of each
/// square of a grid in height and along it, with their lengths inside by winding number. Lines
/// without an end, because a mesh is open, are left out.
/// @param along_W  horizontal, unit: direction of the grid, that of a row
/// @param grid_m   > 0 (demanded)
double enclosed_volume_m3(const std::vector<CanopyTriangle>& triangles,
                          const Eigen::Vector2d& along_W, double grid_m);

}  // namespace vinerow::mapping
