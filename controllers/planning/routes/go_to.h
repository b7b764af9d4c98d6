#pragma once
/// Planner `go_to`: path from the vehicle's position to given places in order, around the obstacles
/// on the map.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec go_to_spec();

/// Each part is a Dubins path if one is free, else the shortened result of the quartile tree on the
/// occupancy grid (rrt_quartile.h). Headings of intermediate places follow from their neighbours.
/// Reports "nodes", "iterations", "length_m", "clearance_m".
/// @throws ConfigError if the map has no grid, or if the vehicle has no turning radius
std::unique_ptr<Planner> make_go_to(const ParameterSet& parameters, const PlannerContext& context);

}  // namespace vinerow::controllers
