#include "controllers/planning/search/goal_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vinerow::controllers {
namespace {

constexpr double kCell_m = 0.2;
// Steps to a straight and a diagonal neighbour in fifths of a cell: 7/5 is within 1 % of sqrt(2).
constexpr int kStraight = 5, kDiagonal = 7;
constexpr int kFar = std::numeric_limits<int>::max();
// Margin by which ground farther from the goal than the start is measured, m, for turning.
constexpr double kBeyondStart_m = 15.0;

/// Radius of the circle around B's origin inside the outline; 0 if the origin is outside.
double calc_inner_radius_m(const std::vector<Eigen::Vector2d>& outline_B) {
  double radius_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline_B.size(); ++i) {
    const Eigen::Vector2d along = outline_B[(i + 1) % outline_B.size()] - outline_B[i];
    if (along.norm() < 1e-12) continue;
    radius_m = std::min(radius_m, cross(along.normalized(), -outline_B[i]));
  }
  return std::max(radius_m, 0.0);
}

}  // namespace

GoalDistance::GoalDistance(DistanceKind kind, const Footprint& footprint,
                           const Eigen::Vector2d& from, const Eigen::Vector2d& goal)
    : goal_(goal) {
  if (kind == DistanceKind::kGeodesic && !footprint.field().empty()) measure(footprint, from);
}

void GoalDistance::measure(const Footprint& footprint, const Eigen::Vector2d& from) {
  const DistanceField& field = footprint.field();
  corner_W_ = field.corner_W();
  columns_ = static_cast<int>(std::ceil(field.size_m().x() / kCell_m));
  rows_ = static_cast<int>(std::ceil(field.size_m().y() / kCell_m));
  const double min_clearance_m = calc_inner_radius_m(footprint.outline_B()) + footprint.margin_m() -
                                 std::sqrt(2.0) * std::max(kCell_m, field.cell_m());
  const auto cell_of = [&](const Eigen::Vector2d& p) {
    const int i = static_cast<int>(std::floor((p.x() - corner_W_.x()) / kCell_m));
    const int j = static_cast<int>(std::floor((p.y() - corner_W_.y()) / kCell_m));
    return i >= 0 && j >= 0 && i < columns_ && j < rows_ ? j * columns_ + i : -1;
  };
  steps_.assign(static_cast<std::size_t>(columns_) * rows_, kFar);
  const int goal_cell = cell_of(goal_), from_cell = cell_of(from);
  if (goal_cell < 0) return;

  // Costs grow by at most 7, so a ring of eight lists holds all waiting cells.
  std::array<std::vector<int>, kDiagonal + 1> waiting;
  steps_[goal_cell] = 0;
  waiting[0].push_back(goal_cell);
  int last = kFar, in_row = 0;
  for (int cost = 0; cost <= last && in_row <= kDiagonal; ++cost) {
    std::vector<int>& now = waiting[cost % waiting.size()];
    in_row = now.empty() ? in_row + 1 : 0;
    for (std::size_t n = 0; n < now.size(); ++n) {
      const int cell = now[n];
      if (steps_[cell] != cost) continue;  // reached more cheaply since
      if (cell == from_cell) last = cost + static_cast<int>(kBeyondStart_m / kCell_m) * kStraight;
      const int i = cell % columns_, j = cell / columns_;
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          const int next_i = i + di, next_j = j + dj;
          if (next_i < 0 || next_j < 0 || next_i >= columns_ || next_j >= rows_) continue;
          const int next = next_j * columns_ + next_i;
          const int next_cost = cost + (di != 0 && dj != 0 ? kDiagonal : kStraight);
          if (next_cost >= steps_[next]) continue;
          const Eigen::Vector2d centre =
              corner_W_ + kCell_m * Eigen::Vector2d(next_i + 0.5, next_j + 0.5);
          if (next != from_cell && field.at(centre) < min_clearance_m) continue;
          steps_[next] = next_cost;
          waiting[next_cost % waiting.size()].push_back(next);
        }
      }
    }
    now.clear();
  }
}

double GoalDistance::at(const Eigen::Vector2d& p_W) const {
  if (columns_ == 0) return (p_W - goal_).norm();
  const int i = static_cast<int>(std::floor((p_W.x() - corner_W_.x()) / kCell_m));
  const int j = static_cast<int>(std::floor((p_W.y() - corner_W_.y()) / kCell_m));
  if (i < 0 || j < 0 || i >= columns_ || j >= rows_) {
    return std::numeric_limits<double>::infinity();
  }
  const int steps = steps_[static_cast<std::size_t>(j) * columns_ + i];
  if (steps == kFar) return std::numeric_limits<double>::infinity();
  return kCell_m * steps / kStraight;
}

}  // namespace vinerow::controllers
