#pragma once
/// Planner `rrt_star`: legs along the alleys and turns by RRT* of OMPL with a first way in closed
/// form (paper A, section 4.1).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow {

PartSpec rrt_star_spec();

/// @throws ConfigError as make_route_planner and read_route_planner_params do
std::unique_ptr<Planner> make_rrt_star(const ParameterSet& parameters,
                                       const PlannerContext& context);

}  // namespace vinerow
