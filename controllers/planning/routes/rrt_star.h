#pragma once
/// Planner `rrt_star`: legs along the alleys and turns by OMPL's RRT* with an initial path in
/// closed form (paper A, section 4.1).

#include <memory>

#include "controllers/planning/routes/route_planner.h"
#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec rrt_star_spec();

/// Parameters of the search alone: iterations, first_iterations, range_m, reach_m, ...
std::vector<ParameterSpec> rrt_star_search_parameters();
/// Makes the search from its parameters. @param route of the planner that uses it
std::unique_ptr<PoseSearch> make_rrt_star_search(const ParameterSet& parameters,
                                                 const RoutePlannerParams& route,
                                                 const PartContext& context);

/// @throws ConfigError as make_route_planner and read_route_planner_params do
std::unique_ptr<Planner> make_rrt_star(const ParameterSet& parameters,
                                       const PlannerContext& context);

}  // namespace vinerow::controllers
