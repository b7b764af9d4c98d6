#pragma once
/// Planner `rrt_quartile`: legs along the alleys and turns by the tree of paper A, section 4.1.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec rrt_quartile_spec();
/// @throws ConfigError for arcs tighter than the vehicle turns, steps that do not leave a cell, and
/// as make_route_planner
std::unique_ptr<Planner> make_rrt_quartile(const ParameterSet& parameters,
                                           const PlannerContext& context);

}  // namespace vinerow::controllers
