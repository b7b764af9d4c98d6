#pragma once
/// The mission with which an autopilot follows a plan of ours.

#include "engine/api/messages/path.h"
#include "engine/api/vehicle.h"
#include "engine/io/missions/mission_file.h"
#include "engine/math/geo.h"

namespace vinerow::io {

/// A waypoint wherever the plan bends, and an item wherever its desired speed changes. Rotorcraft
/// take off and land where the plan goes straight up and down.
///
/// A path with headings may have thousands of points; an autopilot's memory has room for some
/// hundred items, and it slows down at each. So points are left out as long as the straight legs
/// stay near the plan: Ramer-Douglas-Peucker, which keeps the farthest point and repeats on both
/// sides of it.
/// @param tolerance_m  farthest that a leg may be from the plan
/// @returns places in WGS84, home at the plan's start
MissionFile make_plan_mission(const PlannedPath& plan, const VehicleDescription& vehicle,
                              const LocalFrame& frame, double tolerance_m);

}  // namespace vinerow::io
