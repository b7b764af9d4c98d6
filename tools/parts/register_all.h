#pragma once
#include "engine/api/registry.h"

namespace vinerow {

/// Registers the built-in parts of all folders.
void register_all(Registry& registry);

}  // namespace vinerow
