#pragma once
#include "engine/api/registry.h"

namespace vinerow::sensors {

/// Adds the built-in sensors: one line each.
void register_sensors(Registry& registry);

}  // namespace vinerow::sensors
