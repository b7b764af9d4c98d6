#include "controllers/planning/search/rrt_quartile.h"

#include <fmt/format.h>

#include <cmath>

#include "controllers/planning/search/analytic_turn.h"
#include "controllers/planning/search/shortcut.h"

namespace vinerow::controllers {
namespace {

QuartileTreeParams refine(QuartileTreeParams params) {
  params.step_m *= 0.5;
  params.cell_m *= 0.5;
  params.cell_rad *= 0.5;
  return params;
}

}  // namespace

RrtQuartile::RrtQuartile(const RrtQuartileParams& params, PartContext context)
    : params_(params), context_(std::move(context)) {}

Result<std::vector<PathSegment>> RrtQuartile::find(const Pose2& from, const Pose2& to,
                                                   const Footprint& footprint, int problem,
                                                   SearchReport& report) {
  if (!footprint.is_free(from)) {
    return Failure{"start in collision: " + describe_clearance(from, footprint)};
  }
  if (!footprint.is_free(to))
    return Failure{"goal in collision: " + describe_clearance(to, footprint)};
  const GoalDistance distance(params_.heuristic, footprint, from.p, to.p);
  if (std::isinf(distance.at(from.p))) {
    return Failure{"no free ground as wide as the vehicle connects start and goal"};
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
      std::vector<PathSegment> pieces = tree.path();
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

}  // namespace vinerow::controllers
