#pragma once
/// Vehicles' plans as lines for a replay.

#include <Eigen/Core>
#include <vector>

#include "tools/replay/replay_tracks.h"

namespace vinerow::tools {

/// The points of a line that must stay so that no point is farther than `tolerance_m` from it.
/// Source: D. Douglas, T. Peucker, "Algorithms for the reduction of the number of points required
/// to represent a digitized line", Cartographica 10, 1973.
std::vector<Eigen::Vector3d> simplify_line(const std::vector<Eigen::Vector3d>& points,
                                           double tolerance_m);

/// Adds to each vehicle of the index "plans": a list of {"t": s since the run's start, "points":
/// offset of the first of 3 float32 each, m in W, "count"}; each holds until the next. Points stand
/// on the ground or above it.
void add_plans(const ReplayInput& input, const ReplayLimits& limits, ReplayTracks& tracks);

}  // namespace vinerow::tools
