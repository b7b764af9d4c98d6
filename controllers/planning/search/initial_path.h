#pragma once
/// Initial path between two poses in closed form, and shortening of paths.

#include <optional>
#include <vector>

#include "controllers/planning/search/path_cost.h"

namespace vinerow::controllers {

struct InitialPath {
  std::vector<PathSegment> pieces;
  double radius_m = 0.0;  ///< of its arcs
};

/// The cheapest free analytic turn. Radii up to (1 + reserve) times the minimum are then tried,
/// widest first; the first whose turn costs at most twice that share more replaces it, so that a
/// follower has a curvature reserve.
std::optional<InitialPath> find_initial_path(const Pose2& from, const Pose2& to, double radius_m,
                                             double reserve, const Footprint& footprint,
                                             const PathCost& cost, double check_step_m);

bool is_free(const std::vector<PathSegment>& pieces, const Footprint& footprint, double step_m);

/// Dubins paths from pose to pose, neighbours of equal curvature joined.
std::vector<PathSegment> join_poses(const std::vector<Pose2>& poses, double radius_m);

/// Poses along a path, at most `step_m` apart, both ends and all joints included.
std::vector<Pose2> sample_poses(const std::vector<PathSegment>& pieces, double step_m);

/// The path with sections replaced by single Dubins paths that cost less and are free.
std::vector<PathSegment> shorten_by_cost(const std::vector<PathSegment>& pieces, double radius_m,
                                         const Footprint& footprint, const PathCost& cost,
                                         double check_step_m);

}  // namespace vinerow::controllers
