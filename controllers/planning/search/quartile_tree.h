#pragma once
/// Search tree of paper A, section 4.1. From every node three arcs of equal length grow: left,
/// straight and right. The next node is drawn from the lowest quartile of distance to the goal.
///
/// The paper leaves details open; they are chosen so that the search ends. A node is closed once
/// its three arcs have been tried. A child in an occupied cell of (x, y, heading) is dropped,
/// unless it is nearer to the start along the tree; then it takes over the cell (the paper's
/// "rewire"). Every arc is checked with the vehicle's outline at steps. If no node is open, the
/// tree is exhausted. There is no rewiring of near neighbours as in Karaman and Frazzoli's RRT*, so
/// the path is not necessarily the shortest.
///
/// The path ends exactly at the goal: from every new node that is near enough, the shortest Dubins
/// path to the goal is tried, and the first free one ends the search.

#include <cstdint>
#include <vector>

#include "controllers/parts/paths/dubins.h"
#include "controllers/parts/paths/path_pieces.h"
#include "controllers/planning/search/goal_distance.h"
#include "controllers/planning/search/pose_cells.h"
#include "controllers/planning/search/quartile_list.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

struct QuartileTreeParams {
  double curvature_per_m = 0.566;  ///< of the arcs to the left and right, > 0
  double step_m = 0.4;             ///< length of every arc
  double cell_m = 0.2;             ///< of the occupied cells
  double cell_rad = rad_from_deg(8.0);
  double check_step_m = 0.1;  ///< between poses of the collision check
  double join_m = 3.0;        ///< longest Dubins path that joins the tree to the goal
  bool quartiles = true;
};

enum class TreeStatus { kSolved, kExhausted, kIterationLimit };

class QuartileTree {
 public:
  struct Node {
    Pose2 pose;
    int parent = -1;
    int depth = 0;                 ///< arcs from the start
    double curvature_per_m = 0.0;  ///< of the arc that leads here
  };

  /// References must outlive the tree. @pre from and to are free
  QuartileTree(const QuartileTreeParams& params, const Footprint& footprint,
               const GoalDistance& distance, const Pose2& from, const Pose2& to);

  /// Expands at most `max_iterations` nodes.
  TreeStatus grow(std::int64_t max_iterations, RandomStream& random);

  const std::vector<Node>& nodes() const { return nodes_; }
  std::int64_t iterations() const { return iterations_; }
  /// Path from the start exactly to the goal, with neighbouring arcs of equal curvature joined.
  /// @pre grow() returned kSolved
  std::vector<PathSegment> path() const;
  /// Every edge as two straight lines, two points each.
  std::vector<Eigen::Vector2d> edges_W() const;

 private:
  void expand(int node);
  void add(const Node& node, std::uint64_t cell);
  /// Tries to reach the goal from a node.
  void join(int node);

  QuartileTreeParams params_;
  const Footprint& footprint_;
  const GoalDistance& distance_;
  Pose2 to_;
  PoseCells cells_;
  QuartileList list_;
  std::vector<Node> nodes_;
  std::int64_t iterations_ = 0;
  int joined_ = -1;  // node from which the goal was reached
  DubinsPath last_;  // path from there
};

}  // namespace vinerow::controllers
