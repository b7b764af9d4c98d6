#pragma once
#include "engine/api/registry.h"

namespace vinerow {

/// Adds the built-in sensors: one line each.
void register_sensors(Registry& registry);

}  // namespace vinerow
