#pragma once
/// Refuses cameras that would show nothing but the inside of something.

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

/// Looks at the fixed ones: where the others are is known in the run alone.
/// @throws ConfigError "scenario.yaml:30: pictures.cameras: camera 'gate' would stand 2 m below the
/// ground; ..."
void refuse_hidden_cameras(const scenario::PicturesConfig& pictures, const WorldModel& world,
                           const SceneQuery& scene);

}  // namespace vinerow
