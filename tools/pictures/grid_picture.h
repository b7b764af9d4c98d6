#pragma once
/// Top view of a world's occupancy grid, as in figures 15 and 18 of paper A.

#include <string>

#include "engine/api/forward.h"
#include "engine/render/scene.h"
#include "worlds/mapping/grid/occupancy.h"

namespace vinerow::tools {

/// North is up. Free ground is light, rows green, virtual walls blue, turning areas yellow, other
/// occupied cells dark. Alleys are numbered, and boxes missing on the map are outlined.
/// @param world  has an occupancy grid
/// @param title  first line below the map
render::Image draw_grid(const WorldModel& world, const mapping::OccupancyReport& report,
                        const std::string& title);

}  // namespace vinerow::tools
