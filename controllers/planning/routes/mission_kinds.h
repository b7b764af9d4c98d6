#pragma once
/// What the stretches of a mission are for, as far as its items tell.

#include <vector>

#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Of points with kind kLeg: where the camera works it is a leg, between those a turn, before them
/// transit, after them the return; without any camera every stretch is a leg. Legs are numbered:
/// where the camera is switched on, or the way bends by more than half a radian, a new one begins.
/// Also sets the directions.
/// @param camera  at each point: triggered from there on  @param path  >= 2 points
void set_mission_kinds(const std::vector<bool>& camera, bool uses_camera, PlannedPath& path);

}  // namespace vinerow::controllers
