#pragma once
/// Kinds (leg, turn, transit, return) of the stretches of a mission, derived from its camera items.

#include <vector>

#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Sets the kinds of a path whose points have kind kLeg. Stretches with the camera on are legs,
/// those between legs are turns, those before them transit, and those after them the return.
/// Without camera items every stretch is a leg. Legs are numbered; a new one starts where the
/// camera is switched on, or where the path bends by more than half a radian. Also sets the
/// directions.
/// @param camera  at each point: triggered from there on  @param path  >= 2 points
void set_mission_kinds(const std::vector<bool>& camera, bool uses_camera, PlannedPath& path);

}  // namespace vinerow::controllers
