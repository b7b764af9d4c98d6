#include "controllers/planning/rrt_quartile.h"

#include <fmt/format.h>

#include <cmath>

#include "controllers/planning/analytic_turn.h"
#include "controllers/planning/route_planner.h"
#include "controllers/planning/shortcut.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

/// Paper A, section 4.1: steering angles -pi/6, 0, pi/6.
constexpr double kPaperSteer_rad = kPi / 6.0;

std::string describe_taken(const char* which, const Pose2& pose, const Footprint& footprint) {
  return fmt::format(
      "the {} at ({:.2f}, {:.2f}) heading {:.1f} deg is taken: {:.3f} m of room, "
      "the margin is {:.3f} m",
      which, pose.p.x(), pose.p.y(), deg_from_rad(wrap_angle(pose.yaw_rad)),
      footprint.clearance_m(pose), footprint.margin_m());
}

QuartileTreeParams refine(QuartileTreeParams params) {
  params.step_m *= 0.5;
  params.cell_m *= 0.5;
  params.cell_rad *= 0.5;
  return params;
}

/// Curvature of the arcs to the left and right; R the least radius in use.
double read_curvature_per_m(const ParameterSet& parameters, const PlannerContext& context,
                            double radius_m, const std::string& who) {
  const bool has_angle = parameters.has("steering_angle_deg");
  if (has_angle && parameters.has("turning_radius_m")) {
    throw ConfigError(who + ": give steering_angle_deg or turning_radius_m, not both");
  }
  const bool is_four_wheel = parameters.text("steering") == "four_wheel";
  if (parameters.has("turning_radius_m") || (is_four_wheel && !has_angle)) return 1.0 / radius_m;

  const double angle_rad =
      has_angle ? rad_from_deg(parameters.number("steering_angle_deg")) : kPaperSteer_rad;
  const VehicleDescription& vehicle = *context.vehicle_description;
  const double wheel_base_m =
      vehicle.need_positive(vehicle.need_wheeled(who).wheel_base_m, "wheel_base_m", who);
  const double curvature_per_m = (is_four_wheel ? 2.0 : 1.0) * std::tan(angle_rad) / wheel_base_m;
  constexpr double kRounding = 1e-3;  // vehicles tell their radius with few digits
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

RrtQuartile::RrtQuartile(const RrtQuartileParams& params, PartContext context)
    : params_(params), context_(std::move(context)) {}

Result<std::vector<PathPiece>> RrtQuartile::find(const Pose2& from, const Pose2& to,
                                                 const Footprint& footprint, int problem,
                                                 SearchReport& report) {
  if (!footprint.is_free(from)) return Failure{describe_taken("start", from, footprint)};
  if (!footprint.is_free(to)) return Failure{describe_taken("goal", to, footprint)};
  const GoalDistance distance(params_.heuristic, footprint, from.p, to.p);
  if (std::isinf(distance.at(from.p))) {
    return Failure{"no free ground as wide as the vehicle joins start and goal"};
  }

  RandomStream random = context_.random(fmt::format("problem{}", problem));
  QuartileTreeParams tree_params = params_.tree;
  std::string exhausted;  // "3116 nodes in steps of 0.4 m"
  for (int round = 0; round <= params_.refinements; ++round) {
    QuartileTree tree(tree_params, footprint, distance, from, to);
    const TreeStatus status = tree.grow(params_.max_iterations - report.iterations, random);
    report.iterations += tree.iterations();
    report.nodes += static_cast<std::int64_t>(tree.nodes().size());
    const std::vector<Eigen::Vector2d> edges_W = tree.edges_W();
    report.tree_W.insert(report.tree_W.end(), edges_W.begin(), edges_W.end());
    if (status == TreeStatus::kSolved) {
      std::vector<PathPiece> pieces = tree.path();
      if (!params_.smooth) return pieces;
      report.first_length_m = calc_length_m(pieces);
      ShortcutParams shortcut;
      shortcut.radius_m = 1.0 / tree_params.curvature_per_m;
      shortcut.check_step_m = tree_params.check_step_m;
      return shorten_at_random(std::move(pieces), shortcut, footprint, random);
    }
    if (status == TreeStatus::kIterationLimit) {
      return Failure{
          fmt::format("not found within max_iterations = {}: the tree has {} nodes and "
                      "{} of them were expanded",
                      params_.max_iterations, report.nodes, report.iterations)};
    }
    exhausted += fmt::format("{}{} nodes in steps of {:.3g} m", exhausted.empty() ? "" : ", ",
                             tree.nodes().size(), tree_params.step_m);
    tree_params = refine(tree_params);
  }
  return Failure{
      fmt::format("tree exhausted, no sequence of arcs of {:.2f} m radius leads there "
                  "({})",
                  1.0 / tree_params.curvature_per_m, exhausted)};
}

PartSpec rrt_quartile_spec() {
  PartSpec spec;
  spec.name = "rrt_quartile";
  spec.description =
      "Drives the alleys of the row map; turns by the tree of paper A, section 4.1 (three steering "
      "angles, quartiles of the distance to the goal, eq. 22), whose nodes are closed and cells "
      "occupied so that it ends. Near neighbours are not rewired: the way is not claimed to be the "
      "shortest, only shortened afterwards.";
  spec.parameters = route_planner_parameters();
  for (ParameterSpec parameter : {
           choice_parameter(
               "steering", "four_wheel", {"four_wheel", "two_wheel"},
               "four_wheel: both axles steer by opposite angles, curvature 2 tan(angle) "
               "/ wheel base; two_wheel: the front axle alone, tan(angle) / wheel base"),
           optional(number_parameter("steering_angle_deg", "deg", 23.0, 1.0, 60.0,
                                     "of the arcs to the left and right; default four_wheel: the "
                                     "vehicle's turning radius, two_wheel: 30 deg (paper A)")),
           choice_parameter("heuristic", "geodesic", {"geodesic", "euclid"},
                            "distance to the goal along free ground, or straight (eq. 22), which "
                            "points into the row between two alleys"),
           boolean_parameter("quartiles", true,
                             "grow from the lowest quartile of distance that has open nodes; "
                             "false: from any open node"),
           positive_parameter("step_m", "m", 0.4, "length of every arc of the tree"),
           positive_parameter("cell_m", "m", 0.2, "size of the cells that hold one node each"),
           number_parameter("cell_deg", "deg", 8.0, 0.5, 90.0, "the same for headings"),
           positive_parameter("join_m", "m", 3.0,
                              "longest Dubins path that joins the tree to the goal exactly"),
           integer_parameter("max_iterations", 100'000, 1, 1e7,
                             "nodes expanded per turn before the search gives up"),
           integer_parameter("refinements", 1, 0, 4,
                             "when the tree is exhausted, so often again with half the step and "
                             "half the cells"),
           boolean_parameter("smooth", true, "shorten the way found by checked Dubins paths"),
       }) {
    spec.parameters.push_back(std::move(parameter));
  }
  spec.reads = {"estimate"};
  spec.writes = {"plan", "plan_tree"};
  return spec;
}

std::unique_ptr<Planner> make_rrt_quartile(const ParameterSet& parameters,
                                           const PlannerContext& context) {
  const std::string who = context.part + " (rrt_quartile)";
  RoutePlannerParams route = read_route_planner_params(parameters, context, who);
  RrtQuartileParams params;
  params.tree.curvature_per_m =
      read_curvature_per_m(parameters, context, route.turning_radius_m, who);
  route.turning_radius_m = 1.0 / params.tree.curvature_per_m;
  params.tree.step_m = parameters.number("step_m");
  params.tree.cell_m = parameters.number("cell_m");
  params.tree.cell_rad = rad_from_deg(parameters.number("cell_deg"));
  params.tree.check_step_m = route.check_step_m;
  params.tree.join_m = parameters.number("join_m");
  params.tree.quartiles = parameters.boolean("quartiles");
  params.heuristic =
      parameters.text("heuristic") == "euclid" ? DistanceKind::kEuclid : DistanceKind::kGeodesic;
  params.max_iterations = parameters.integer("max_iterations");
  params.refinements = static_cast<int>(parameters.integer("refinements"));
  params.smooth = parameters.boolean("smooth");
  const double diagonal_m = std::sqrt(2.0) * params.tree.cell_m;
  if (params.tree.step_m <= diagonal_m) {
    throw ConfigError(
        fmt::format("{}: step_m = {:.4g} m, must be longer than a cell's diagonal, "
                    "{:.4g} m (cell_m = {:.4g} m)",
                    who, params.tree.step_m, diagonal_m, params.tree.cell_m));
  }
  return make_route_planner(route, std::make_unique<RrtQuartile>(params, context), context);
}

}  // namespace vinerow
