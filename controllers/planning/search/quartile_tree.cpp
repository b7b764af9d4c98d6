#include "controllers/planning/search/quartile_tree.h"

#include <algorithm>

#include "engine/core/check.h"

namespace vinerow::controllers {

// Plan of the search, with kappa = curvature_per_m, h = step_m, R = 1 / kappa:
//
//   tree = {start}, all nodes open
//   while no node has reached the goal:
//     node <- random open node of the lowest quartile of distance to the goal (QuartileList)
//     none: exhausted;  close node
//     for curvature in (kappa, 0, -kappa):
//       child = end of the arc of length h from node
//       the cell of child holds a node with depth <= that of child: drop child
//       the outline along the arc is not free: drop child
//       close the node that held the cell;  add child, open
//       Dubins path of radius R from child to the goal is short enough and free: solved
//
// Every arc has length h, so depth * h is the length of the path from the start. A cell is taken
// over only by a shorter path, so each cell changes hands finitely often and the search ends.

QuartileTree::QuartileTree(const QuartileTreeParams& params, const Footprint& footprint,
                           const GoalDistance& distance, const Pose2& from, const Pose2& to)
    : params_(params),
      footprint_(footprint),
      distance_(distance),
      to_(to),
      cells_(params.cell_m, params.cell_rad),
      list_(params.quartiles) {
  VINEROW_DEMAND(params.curvature_per_m > 0.0 && params.step_m > 0.0 && params.check_step_m > 0.0);
  add({from, -1, 0, 0.0}, cells_.key(from));
}

TreeStatus QuartileTree::grow(std::int64_t max_iterations, RandomStream& random) {
  while (joined_ < 0) {
    const int node = list_.draw(random);
    if (node < 0) return TreeStatus::kExhausted;
    if (iterations_ >= max_iterations) return TreeStatus::kIterationLimit;
    ++iterations_;
    list_.close(node);
    expand(node);
  }
  return TreeStatus::kSolved;
}

void QuartileTree::expand(int node) {
  for (const double side : {1.0, 0.0, -1.0}) {
    const Node parent = nodes_[node];  // a copy: nodes_ grows
    const double curvature_per_m = side * params_.curvature_per_m;
    const Node child = {advance(parent.pose, params_.step_m, params_.step_m * curvature_per_m),
                        node, parent.depth + 1, curvature_per_m};
    const std::uint64_t cell = cells_.key(child.pose);
    // The cheap test of the cell precedes the collision check.
    const int holder = cells_.find(cell);
    if (holder >= 0 && nodes_[holder].depth <= child.depth) continue;
    if (!footprint_.is_free_along(parent.pose, params_.step_m, curvature_per_m,
                                  params_.check_step_m)) {
      continue;
    }
    // The former holder stays in the tree with its children but does not grow any more.
    if (holder >= 0) list_.close(holder);
    add(child, cell);
    if (joined_ >= 0) return;
  }
}

void QuartileTree::add(const Node& node, std::uint64_t cell) {
  nodes_.push_back(node);
  const int number = list_.add(distance_.at(node.pose.p));
  cells_.set(cell, number);
  join(number);
}

void QuartileTree::join(int node) {
  const Pose2& from = nodes_[node].pose;
  // The straight distance is a lower bound of the Dubins length.
  if ((from.p - to_.p).norm() > params_.join_m) return;
  const DubinsPath dubins = calc_dubins(from, to_, 1.0 / params_.curvature_per_m);
  if (dubins.length_m() > params_.join_m) return;
  Pose2 pose = from;
  for (const DubinsPath::Piece& piece : dubins.pieces) {
    if (!footprint_.is_free_along(pose, piece.length_m, piece.curvature_per_m,
                                  params_.check_step_m)) {
      return;
    }
    pose = advance(pose, piece.length_m, piece.length_m * piece.curvature_per_m);
  }
  joined_ = node;
  last_ = dubins;
}

std::vector<PathSegment> QuartileTree::path() const {
  VINEROW_DEMAND(joined_ >= 0);
  std::vector<int> chain;
  for (int node = joined_; nodes_[node].parent >= 0; node = nodes_[node].parent) {
    chain.push_back(node);
  }
  std::reverse(chain.begin(), chain.end());
  std::vector<PathSegment> pieces;
  for (const int node : chain) {
    const double curvature_per_m = nodes_[node].curvature_per_m;
    if (!pieces.empty() && pieces.back().curvature_per_m == curvature_per_m) {
      pieces.back().length_m += params_.step_m;
    } else {
      pieces.push_back({nodes_[nodes_[node].parent].pose, params_.step_m, curvature_per_m,
                        PathKind::kTurn, -1, 0.0});
    }
  }
  append_dubins(nodes_[joined_].pose, last_, PathKind::kTurn, 0.0, pieces);
  return pieces;
}

std::vector<Eigen::Vector2d> QuartileTree::edges_W() const {
  std::vector<Eigen::Vector2d> points;
  points.reserve(4 * nodes_.size());
  for (const Node& node : nodes_) {
    if (node.parent < 0) continue;
    const Pose2& from = nodes_[node.parent].pose;
    const double half_m = 0.5 * params_.step_m;
    const Pose2 middle = advance(from, half_m, half_m * node.curvature_per_m);
    points.insert(points.end(), {from.p, middle.p, middle.p, node.pose.p});
  }
  return points;
}

}  // namespace vinerow::controllers
