#pragma once
/// A first drivable way between two poses in closed form, and the shortening of ways.

#include <optional>
#include <vector>

#include "controllers/planning/search/way_cost.h"

namespace vinerow::controllers {

struct FirstWay {
  std::vector<PathPiece> pieces;
  double radius_m = 0.0;  ///< of its arcs
};

/// The cheapest free analytic turn. Then radii up to (1 + reserve) times the least one are tried,
/// widest first; the first whose turn costs at most twice that share more is taken instead, so that
/// a follower has curvature to spare.
std::optional<FirstWay> find_first_way(const Pose2& from, const Pose2& to, double radius_m,
                                       double reserve, const Footprint& footprint,
                                       const WayCost& cost, double check_step_m);

bool is_free(const std::vector<PathPiece>& pieces, const Footprint& footprint, double step_m);

/// Dubins paths from pose to pose, neighbours of equal curvature joined.
std::vector<PathPiece> join_poses(const std::vector<Pose2>& poses, double radius_m);

/// Poses along a way, at most `step_m` apart, both ends and all joints included.
std::vector<Pose2> sample_poses(const std::vector<PathPiece>& pieces, double step_m);

/// The way with stretches replaced by single Dubins paths where those cost less and are free.
std::vector<PathPiece> shorten_by_cost(const std::vector<PathPiece>& pieces, double radius_m,
                                       const Footprint& footprint, const WayCost& cost,
                                       double check_step_m);

}  // namespace vinerow::controllers
