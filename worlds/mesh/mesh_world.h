#pragma once
/// World `mesh`: mesh files placed by pose, SDF worlds, or both.

#include "engine/api/registry.h"

namespace vinerow::worlds {

void register_mesh(Registry& registry);

}  // namespace vinerow::worlds
