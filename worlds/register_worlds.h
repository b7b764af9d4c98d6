#pragma once
/// The worlds that come with Vinerow.

#include "engine/api/registry.h"

namespace vinerow::worlds {

/// orchard, vineyard, surveyed, mesh.
void register_worlds(Registry& registry);

}  // namespace vinerow::worlds
