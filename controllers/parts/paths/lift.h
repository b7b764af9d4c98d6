#pragma once
/// Projection of planned points onto the ground.

#include <optional>
#include <string>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"

namespace vinerow::controllers {

/// Height above any ground within a scenario.
inline constexpr double kAboveEverything_m = 1e4;

/// Sets each point's height to the ground below it. Without a scene, or if the scene has no ground
/// under any point, all points get `height_m`.
/// @returns nullopt, or "path leaves the ground: ..." if only part of the path has ground below
std::optional<std::string> lift_to_ground(const SceneQuery* scene, double height_m,
                                          PlannedPath& path);

}  // namespace vinerow::controllers
