#pragma once
/// Puts planned points onto the ground.

#include "engine/api/messages.h"
#include "engine/api/scene_query.h"

namespace vinerow {

/// Sets each point's height to the ground below it; where there is none, the nearest earlier height
/// is kept. Without a scene all points get `height_m`.
void lift_to_ground(const SceneQuery* scene, double height_m, PlannedPath& path);

}  // namespace vinerow
