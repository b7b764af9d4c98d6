#include <algorithm>
#include <cmath>

#include "controllers/planning/routes/route_planner.h"
#include "controllers/planning/search/analytic_turn.h"
#include "engine/api/messages/grid.h"

namespace vinerow::controllers {
namespace {

constexpr double kClearanceStep_m = 0.1;

OccupancyGrid make_window(const Pose2& from, const Pose2& to, const DistanceField& field) {
  OccupancyGrid window;
  window.cell_m = field.cell_m();
  window.corner_W = from.p.cwiseMin(to.p).array() - kClearanceReach_m;
  const Eigen::Vector2d size =
      from.p.cwiseMax(to.p).array() + kClearanceReach_m - window.corner_W.array();
  window.columns = static_cast<int>(std::ceil(size.x() / window.cell_m));
  window.rows = static_cast<int>(std::ceil(size.y() / window.cell_m));
  window.cells.assign(static_cast<std::size_t>(window.columns) * window.rows, 0);
  return window;
}

/// Cells that the point `from` can reach, as the occupied cells of a new grid.
OccupancyGrid fill_reachable(const Pose2& from, const Pose2& to, const DistanceField& field) {
  OccupancyGrid reached = make_window(from, to, field);
  std::vector<std::pair<int, int>> open;
  const auto visit = [&](int i, int j) {
    if (i < 0 || j < 0 || i >= reached.columns || j >= reached.rows || reached.occupied(i, j)) {
      return;
    }
    const Eigen::Vector2d centre =
        reached.corner_W + reached.cell_m * Eigen::Vector2d(i + 0.5, j + 0.5);
    // Walls count as at least half a cell wide, whatever the offset between the two grids.
    if (field.at(centre) <= 0.5 * reached.cell_m) return;
    reached.cells[static_cast<std::size_t>(j) * reached.columns + i] = 1;
    open.emplace_back(i, j);
  };
  const Eigen::Vector2d first = (from.p - reached.corner_W) / reached.cell_m;
  visit(static_cast<int>(first.x()), static_cast<int>(first.y()));
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    visit(i + 1, j);
    visit(i - 1, j);
    visit(i, j + 1);
    visit(i, j - 1);
  }
  return reached;
}

std::vector<Eigen::Vector2d> sample_outline(const std::vector<Eigen::Vector2d>& outline_B) {
  std::vector<Eigen::Vector2d> samples;
  for (std::size_t i = 0; i < outline_B.size(); ++i) {
    const Eigen::Vector2d &a = outline_B[i], &b = outline_B[(i + 1) % outline_B.size()];
    const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / kClearanceStep_m)));
    for (int k = 0; k < parts; ++k) samples.push_back(a + (b - a) * k / parts);
  }
  return samples;
}

}  // namespace

std::optional<double> calc_missing_clearance_m(const Pose2& from, const Pose2& to, double radius_m,
                                               const DistanceField& field,
                                               const std::vector<Eigen::Vector2d>& outline_B,
                                               double margin_m) {
  if (field.empty()) return 0.0;
  const OccupancyGrid reachable = fill_reachable(from, to, field);
  const DistanceField beyond(reachable);  // distance of a point from the reachable ground
  if (field.at(from.p) <= 0.0 || field.at(to.p) <= 0.0 || beyond.at(to.p) > field.cell_m()) {
    return std::nullopt;
  }
  const std::vector<Eigen::Vector2d> samples = sample_outline(outline_B);
  // A turn that leaves the window is not followed farther: it can have thousands of kilometres.
  double min_m = margin_m + kClearanceReach_m;
  AnalyticTurnParams turn;
  turn.radius_m = radius_m;
  turn.lead_step_m = 0.5;
  for (const AnalyticTurn& candidate : make_analytic_turns(from, to, turn)) {
    double missing_m = 0.0;
    for (const PathSegment& piece : make_pieces(from, to, candidate)) {
      if (missing_m >= min_m) break;
      const int parts = static_cast<int>(std::ceil(piece.length_m / kClearanceStep_m));
      for (int k = 0; k <= parts && missing_m < min_m; ++k) {
        const Pose2 pose = piece.at(piece.length_m * k / parts);
        const Eigen::Vector2d ahead = direction(pose.yaw_rad), left = left_of(ahead);
        for (const Eigen::Vector2d& p_B : samples) {
          const Eigen::Vector2d p = pose.p + p_B.x() * ahead + p_B.y() * left;
          // Outside the window a point is at least as far away as its edge.
          const double outside_m = beyond.covers(p) ? beyond.at(p) : kClearanceReach_m;
          const double distance_m = outside_m > 0.0 ? -outside_m : field.at(p);
          missing_m = std::max(missing_m, margin_m - distance_m);
        }
      }
    }
    min_m = std::min(min_m, missing_m);
  }
  return min_m;
}

}  // namespace vinerow::controllers
