#include "controllers/planning/routes/rrt_star.h"

#include <fmt/format.h>

#include "controllers/planning/routes/route_planner.h"
#include "controllers/planning/search/rrt_star_search.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {

namespace {

/// Without radius_m and check_step_m, which come from the route.
const ParameterTable<RrtStarParams>& rrt_star_table() {
  using P = RrtStarParams;
  using Cost = PathCostParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("iterations", &P::iterations, between(0, 5e3),
                   "iterations of RRT* for every turn that can be shorter; 0: keep the initial "
                   "path; the cost grows with the square")
          .integer("first_iterations", &P::first_iterations, between(1, 2e4),
                   "iterations of RRT if no turn in closed form fits; it stops at the first path; "
                   "the cost grows with the square")
          .number("range_m", "m", &P::range_m, between(0.1, 1e4), "longest edge of the tree")
          .number("reach_m", "m", &P::reach_m, between(0.1, 1e4),
                  "distance around both ends within which paths are searched")
          .number("curvature_reserve", "", &P::curvature_reserve, between(0.0, 1.0),
                  "share by which turns may be wider than the minimum radius if there is "
                  "clearance, so that the follower has a steering reserve")
          .number("clearance_weight", "", inside(&P::cost, &Cost::clearance_weight),
                  between(0.0, 100.0), "a metre at zero clearance costs 1 + this")
          .number("wanted_clearance_m", "m", inside(&P::cost, &Cost::wanted_clearance_m),
                  between(1e-3, 1e3), "clearance above which a metre costs 1")
          .number("bend_cost_m", "m", inside(&P::cost, &Cost::bend_m), between(0.0, 10.0),
                  "length that costs as much as a change of curvature");
  return table;
}

}  // namespace

std::vector<ParameterSpec> rrt_star_search_parameters() {
  return rrt_star_table().specs();
}

std::unique_ptr<PoseSearch> make_rrt_star_search(const ParameterSet& parameters,
                                                 const RoutePlannerParams& route,
                                                 const PartContext& context) {
  RrtStarParams params = rrt_star_table().read(parameters, context.part);
  params.radius_m = route.turning_radius_m;
  params.check_step_m = route.check_step_m;
  const auto random_of = [own = context](int stream) {
    return own.random(fmt::format("turn_{}", stream));
  };
  return std::make_unique<RrtStarSearch>(params, random_of);
}

PartSpec rrt_star_spec() {
  PartSpec spec;
  spec.name = "rrt_star";
  spec.description =
      "Path with legs along the alleys and turns on the occupancy grid: an initial turn in closed "
      "form, improved by RRT* (Karaman, Frazzoli 2011) in OMPL for a car-like vehicle (paper A, "
      "4.1).";
  route_planner_table().add_to(spec);
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

}  // namespace vinerow::controllers
