#pragma once
/// What a picture of a world needs to know besides its glTF scene: light, ground, textures.

#include <nlohmann/json.hpp>
#include <string>

#include "engine/api/world_model.h"
#include "tools/replay/replay_textures.h"

namespace vinerow::tools {

/// {"name", "ground": rows, alleys and extents, "light", "textures"}
nlohmann::json replay_index(const std::string& name, const WorldModel& world,
                            const ReplayTextures& textures);

}  // namespace vinerow::tools
