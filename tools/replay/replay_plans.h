#pragma once
/// Plans of the vehicles as lines for a replay.

#include <Eigen/Core>
#include <vector>

#include "tools/replay/replay_tracks.h"

namespace vinerow::tools {

/// Line with fewer points, from which no original point is farther than `tolerance_m`.
/// Source: D. Douglas, T. Peucker, "Algorithms for the reduction of the number of points required
/// to represent a digitized line", Cartographica 10, 1973.
std::vector<Eigen::Vector3d> simplify_line(const std::vector<Eigen::Vector3d>& points,
                                           double tolerance_m);

/// Adds to each vehicle of the index "plans": a list of {"t": s since the run's start, "points":
/// offset of the first of 3 float32 each, m in W, "count"}; each is valid until the next. Points
/// are on the ground or above it.
void add_plans(const ReplayInput& input, const ReplayLimits& limits, ReplayTracks& tracks);

}  // namespace vinerow::tools
