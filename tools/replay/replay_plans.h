#pragma once
/// Plans of the vehicles as lines for a replay.

#include "tools/replay/replay_tracks.h"

namespace vinerow::tools {

/// Adds to each vehicle of the index "plans": a list of {"t": s since the run's start, "points":
/// offset of the first of 3 float32 each, m in W, "count"}; each is valid until the next. Points
/// are on the ground or above it.
void add_plans(const ReplayInput& input, const ReplayLimits& limits, ReplayTracks& tracks);

}  // namespace vinerow::tools
