#pragma once
/// Planner `go_to`: from where the vehicle stands to one place after the other, around what the map
/// has in the way.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec go_to_spec();

/// Each way by Dubins' words where one is free, else by the quartile tree on the occupancy grid
/// (rrt_quartile.h), shortened; headings of places between follow from their neighbours. Reports
/// "nodes", "iterations", "length_m", "clearance_m".
/// @throws ConfigError if the map has no grid, or the vehicle no turning radius
std::unique_ptr<Planner> make_go_to(const ParameterSet& parameters, const PlannerContext& context);

}  // namespace vinerow::controllers
