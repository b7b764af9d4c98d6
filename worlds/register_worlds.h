#pragma once
/// Registration of the built-in worlds.

#include "engine/api/registry.h"

namespace vinerow::worlds {

/// orchard, vineyard, surveyed, mesh.
void register_worlds(Registry& registry);

}  // namespace vinerow::worlds
