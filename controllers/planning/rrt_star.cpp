#include "controllers/planning/rrt_star.h"

#include <fmt/format.h>

#include "controllers/planning/route_planner.h"
#include "controllers/planning/rrt_star_search.h"

namespace vinerow {

std::vector<ParameterSpec> rrt_star_search_parameters() {
  return {
      integer_parameter("iterations", 500, 0, 1e7,
                        "of RRT*, for every turn that a shorter way is possible for; 0: the "
                        "first way stands"),
      integer_parameter("first_iterations", 10'000, 1, 1e7,
                        "of RRT, where no turn in closed form fits; it stops at the first way"),
      positive_parameter("range_m", "m", 3.0, "longest edge of the tree"),
      positive_parameter("reach_m", "m", 8.0, "how far around both ends ways are looked for"),
      number_parameter("curvature_reserve", "", 0.05, 0.0, 1.0,
                       "turns are wider than the least radius by up to this share where "
                       "there is room, so that the follower can steer in"),
      number_parameter("clearance_weight", "", 0.5, 0.0, 100.0,
                       "a metre driven at no clearance costs 1 + this"),
      positive_parameter("wanted_clearance_m", "m", 0.3,
                         "from here on clearance costs nothing more"),
      number_parameter("bend_cost_m", "m", 0.2, 0.0, 10.0,
                       "every change of curvature costs as much as this length"),
  };
}

std::unique_ptr<PoseSearch> make_rrt_star_search(const ParameterSet& parameters,
                                                 const RoutePlannerParams& route,
                                                 const PartContext& context) {
  RrtStarParams params;
  params.radius_m = route.turning_radius_m;
  params.check_step_m = route.check_step_m;
  params.iterations = parameters.integer("iterations");
  params.first_iterations = parameters.integer("first_iterations");
  params.range_m = parameters.number("range_m");
  params.reach_m = parameters.number("reach_m");
  params.curvature_reserve = parameters.number("curvature_reserve");
  params.cost.clearance_weight = parameters.number("clearance_weight");
  params.cost.wanted_clearance_m = parameters.number("wanted_clearance_m");
  params.cost.bend_m = parameters.number("bend_cost_m");
  const auto random_of = [own = context](int stream) {
    return own.random(fmt::format("turn_{}", stream));
  };
  return std::make_unique<RrtStarSearch>(params, random_of);
}

PartSpec rrt_star_spec() {
  PartSpec spec;
  spec.name = "rrt_star";
  spec.description =
      "Plans legs along the alleys and turns on the occupancy grid: a first turn in closed form, "
      "improved by RRT* (Karaman, Frazzoli 2011) in OMPL for a car-like vehicle (paper A, 4.1).";
  spec.parameters = route_planner_parameters();
  for (ParameterSpec& parameter : rrt_star_search_parameters()) {
    spec.parameters.push_back(std::move(parameter));
  }
  spec.reads = {"estimate"};
  spec.writes = {"plan", "plan_tree"};
  return spec;
}

std::unique_ptr<Planner> make_rrt_star(const ParameterSet& parameters,
                                       const PlannerContext& context) {
  const RoutePlannerParams route =
      read_route_planner_params(parameters, context, context.part + " (rrt_star)");
  return make_route_planner(route, make_rrt_star_search(parameters, route, context), context);
}

}  // namespace vinerow
