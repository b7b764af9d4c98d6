#include "controllers/planning/routes/rrt_quartile_planner.h"

#include <fmt/format.h>

#include <cmath>

#include "controllers/planning/routes/route_planner.h"
#include "controllers/planning/search/rrt_quartile.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

/// Paper A, section 4.1: steering angles -pi/6, 0, pi/6.
constexpr double kPaperSteer_rad = kPi / 6.0;

enum class Steering { kFourWheel, kTwoWheel };

/// All parameters of the planner.
struct QuartilePlannerParams {
  RoutePlannerParams route;
  Steering steering = Steering::kFourWheel;
  std::optional<double> steering_angle_rad;
  RrtQuartileParams search;
};

std::string find_fault_in_steps(const QuartilePlannerParams& p) {
  const QuartileTreeParams& tree = p.search.tree;
  const double diagonal_m = std::sqrt(2.0) * tree.cell_m;
  if (tree.step_m > diagonal_m) return "";
  return fmt::format(
      "step_m = {:.4g} m, must be longer than a cell's diagonal, {:.4g} m (cell_m = {:.4g} m)",
      tree.step_m, diagonal_m, tree.cell_m);
}

/// Parameters of route_planner.h, of this planner and of the tree; the tree's curvature follows
/// from them.
const ParameterTable<QuartilePlannerParams>& rrt_quartile_table() {
  using P = QuartilePlannerParams;
  using Search = RrtQuartileParams;
  using Tree = QuartileTreeParams;
  const auto search = [](auto member) { return inside(&P::search, member); };
  const auto tree = [](auto member) { return inside(&P::search, &Search::tree, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .include(&P::route, route_planner_table())
          .choice("steering", &P::steering,
                  {{"four_wheel", Steering::kFourWheel}, {"two_wheel", Steering::kTwoWheel}},
                  "four_wheel: both axles steer by opposite angles, curvature 2 tan(angle) "
                  "/ wheel base; two_wheel: the front axle alone, tan(angle) / wheel base")
          .degrees("steering_angle_deg", &P::steering_angle_rad, between(1.0, 60.0),
                   "steering angle of the arcs to the left and right; default four_wheel: from the "
                   "vehicle's turning radius, two_wheel: 30 deg (paper A)")
          .choice("heuristic", search(&Search::heuristic),
                  {{"geodesic", DistanceKind::kGeodesic}, {"euclid", DistanceKind::kEuclid}},
                  "distance to the goal: along free ground, or straight (eq. 22), which leads into "
                  "the row between two alleys")
          .boolean("quartiles", tree(&Tree::quartiles),
                   "true: grow from the lowest quartile of distance that has open nodes; false: "
                   "from any open node")
          .number("step_m", "m", tree(&Tree::step_m), between(0.02, 100.0),
                  "length of every arc of the tree")
          .number("cell_m", "m", tree(&Tree::cell_m), between(0.01, 100.0),
                  "size of the cells, each of which holds one node")
          .degrees("cell_deg", tree(&Tree::cell_rad), between(0.5, 90.0),
                   "size of the cells in heading")
          .number("join_m", "m", tree(&Tree::join_m), between(0.01, 1e4),
                  "longest Dubins path that joins the tree to the goal")
          .integer("max_iterations", search(&Search::max_iterations),
                   between(1, kMaxQuartileIterations), "maximum number of nodes expanded per turn")
          .integer("refinements", search(&Search::refinements), between(0, 4),
                   "number of further searches after the tree is exhausted, each with half the "
                   "step and half the cells")
          .boolean("smooth", search(&Search::smooth),
                   "shorten the path found by checked Dubins paths")
          .rule([](const P& p) -> std::string {
            return p.steering_angle_rad && p.route.wanted_radius_m
                       ? "give steering_angle_deg or turning_radius_m, not both"
                       : "";
          })
          .rule(find_fault_in_steps);
  return table;
}

/// Curvature of the arcs to the left and right.
double find_curvature_per_m(const QuartilePlannerParams& params, const PlannerContext& context,
                            const std::string& who) {
  const double radius_m = params.route.turning_radius_m;  // the minimum in use
  const bool is_four_wheel = params.steering == Steering::kFourWheel;
  const bool has_angle = params.steering_angle_rad.has_value();
  if (params.route.wanted_radius_m || (is_four_wheel && !has_angle)) return 1.0 / radius_m;

  const double angle_rad = params.steering_angle_rad.value_or(kPaperSteer_rad);
  const VehicleDescription& vehicle = *context.vehicle_description;
  const double wheel_base_m =
      vehicle.need_positive(vehicle.need_wheeled(who).wheel_base_m, "wheel_base_m", who);
  const double curvature_per_m = (is_four_wheel ? 2.0 : 1.0) * std::tan(angle_rad) / wheel_base_m;
  constexpr double kRounding = 1e-3;  // radii of vehicles have few digits
  if (curvature_per_m * radius_m > 1.0 + kRounding) {
    throw ConfigError(fmt::format(
        "{}: steering_angle_deg = {:.4g} deg on {} turns at a radius of {:.3f} m, the vehicle at "
        "{:.3f} m or more",
        who, deg_from_rad(angle_rad), is_four_wheel ? "both axles" : "the front axle",
        1.0 / curvature_per_m, radius_m));
  }
  return curvature_per_m;
}

}  // namespace

PartSpec rrt_quartile_spec() {
  PartSpec spec;
  spec.name = "rrt_quartile";
  spec.description =
      "Path along the alleys of the row map with turns from the tree of paper A, section 4.1 "
      "(three steering angles, quartiles of the distance to the goal, eq. 22). Nodes are closed "
      "and cells occupied so that the search ends. Near neighbours are not rewired, so the path is "
      "not necessarily the shortest; it is shortened afterwards.";
  rrt_quartile_table().add_to(spec);
  spec.reads = {"estimate"};
  spec.writes = {"plan", "plan_tree"};
  return spec;
}

std::unique_ptr<Planner> make_rrt_quartile(const ParameterSet& parameters,
                                           const PlannerContext& context) {
  const std::string who = context.part + " (rrt_quartile)";
  QuartilePlannerParams params = rrt_quartile_table().read(parameters, who);
  complete_route_params(context, who, params.route);
  QuartileTreeParams& tree = params.search.tree;
  tree.curvature_per_m = find_curvature_per_m(params, context, who);
  params.route.turning_radius_m = 1.0 / tree.curvature_per_m;
  tree.check_step_m = params.route.check_step_m;
  return make_route_planner(params.route, std::make_unique<RrtQuartile>(params.search, context),
                            context);
}

}  // namespace vinerow::controllers
