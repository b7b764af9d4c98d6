#pragma once
/// Check for cameras that would show only the inside of something.

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

/// Checks fixed cameras. The positions of other cameras are known only during the run.
/// @throws ConfigError "scenario.yaml:30: camera 'gate' would be inside the obstacle 'shed'; ..."
void refuse_hidden_cameras(const scenario::PicturesConfig& pictures, const WorldModel& world,
                           const SceneQuery& scene);

}  // namespace vinerow
