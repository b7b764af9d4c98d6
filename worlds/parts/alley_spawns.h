#pragma once
/// Where vehicles can start: both ends of every alley.

#include "engine/api/forward.h"

namespace vinerow::worlds {

/// "alley_<k>_start" and "alley_<k>_end", both on the alley's end points, looking into the alley.
void add_alley_spawn_points(WorldModel& world);

}  // namespace vinerow::worlds
