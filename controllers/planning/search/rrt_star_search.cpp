#include "controllers/planning/search/rrt_star_search.h"

#include <fmt/format.h>
#include <ompl/util/Exception.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/planning/search/analytic_turn.h"
#include "controllers/planning/search/car_planners.h"
#include "controllers/planning/search/initial_path.h"

namespace vinerow::controllers {
namespace {

std::optional<std::string> find_collision(const Pose2& pose, const char* name,
                                          const Footprint& footprint) {
  if (footprint.is_free(pose)) return std::nullopt;
  return fmt::format("{} in collision: {}", name, describe_clearance(pose, footprint));
}

/// Adds a tree's nodes, iterations and edges, the latter as straight lines.
void fill_report(const CarTree& tree, double radius_m, SearchReport& report) {
  constexpr double kStroke_m = 0.4;
  report.nodes += tree.nodes;
  report.iterations += tree.iterations;
  for (const auto& [from, to] : tree.edges) {
    const DubinsPath path = calc_dubins(from, to, radius_m);
    const int parts = std::max(1, static_cast<int>(std::ceil(path.length_m() / kStroke_m)));
    Eigen::Vector2d last = from.p;
    for (int i = 1; i <= parts; ++i) {
      const Eigen::Vector2d next = pose_on_dubins(from, path, path.length_m() * i / parts).p;
      report.tree_W.push_back(last);
      report.tree_W.push_back(next);
      last = next;
    }
  }
}

}  // namespace

RrtStarSearch::RrtStarSearch(const RrtStarParams& params,
                             std::function<RandomStream(int)> random_of)
    : params_(params), random_of_(std::move(random_of)) {}

Result<PathSegments> RrtStarSearch::find(const Pose2& from, const Pose2& to,
                                         const Footprint& footprint, int problem,
                                         SearchReport& report) try {
  report = {};
  if (const auto fault = find_collision(from, "start", footprint)) return Failure{*fault};
  if (const auto fault = find_collision(to, "goal", footprint)) return Failure{*fault};

  const PathCost cost(params_.cost, footprint);
  CarProblem car;
  car.radius_m = params_.radius_m;
  car.low_W = from.p.cwiseMin(to.p).array() - params_.reach_m;
  car.high_W = from.p.cwiseMax(to.p).array() + params_.reach_m;
  car.footprint = &footprint;
  car.cost = &cost;
  car.check_step_m = params_.check_step_m;
  car.range_m = params_.range_m;
  CarSampling sampling;
  sampling.from = from;
  sampling.to = to;
  sampling.footprint = &footprint;
  sampling.best_cost = [] { return std::numeric_limits<double>::infinity(); };

  PathSegments best;
  if (const auto first = find_initial_path(from, to, params_.radius_m, params_.curvature_reserve,
                                           footprint, cost, params_.check_step_m)) {
    best = first->pieces;
    car.radius_m = first->radius_m;
  } else {
    car.iterations = params_.first_iterations;
    const CarTree tree = run_rrt(car, sampling, random_of_(2 * problem));
    fill_report(tree, car.radius_m, report);
    best = join_poses(tree.waypoints, car.radius_m);
    if (best.empty() || !is_free(best, footprint, params_.check_step_m)) {
      return Failure{
          fmt::format("no closed form fits the turning radius of {:.2f} m, and a tree of {} nodes "
                      "found no path in {} iterations within {:.1f} m",
                      params_.radius_m, tree.nodes, tree.iterations, params_.reach_m)};
    }
  }
  report.first_length_m = calc_length_m(best);
  const auto improve = [&](const PathSegments& candidate) {
    // A gain of one per cent does not justify more bends.
    constexpr double kWorthwhile = 0.99;
    const PathSegments shorter =
        shorten_by_cost(candidate, car.radius_m, footprint, cost, params_.check_step_m);
    if (cost.of(shorter) < kWorthwhile * cost.of(best) &&
        is_free(shorter, footprint, params_.check_step_m)) {
      best = shorter;
    }
  };
  improve(best);

  const double known = cost.of(best);
  const double min_m = calc_dubins(from, to, car.radius_m).length_m();
  // The initial path is optimal if it is the shortest for this radius without obstacles.
  if (params_.iterations == 0 || known <= min_m * (1.0 + 1e-6)) return best;
  constexpr double kSeedPitch_m = 0.75;
  car.iterations = params_.iterations;
  sampling.initial_path = sample_poses(best, std::min(kSeedPitch_m, 0.5 * params_.range_m));
  sampling.initial_path.erase(sampling.initial_path.begin());  // the root of the tree
  sampling.best_cost = [known] { return known; };
  const CarTree tree = run_rrt_star(car, sampling, random_of_(2 * problem + 1));
  fill_report(tree, car.radius_m, report);
  if (tree.waypoints.size() > 1) improve(join_poses(tree.waypoints, car.radius_m));
  return best;
} catch (const ompl::Exception& fault) {
  return Failure{fmt::format("OMPL failed: {}", fault.what())};
}

}  // namespace vinerow::controllers
