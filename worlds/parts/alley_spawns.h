#pragma once
/// Spawn points at both ends of every alley.

#include "engine/api/forward.h"

namespace vinerow::worlds {

/// "alley_<k>_start" and "alley_<k>_end", on the alley's end points, heading into the alley.
void add_alley_spawn_points(WorldModel& world);

}  // namespace vinerow::worlds
