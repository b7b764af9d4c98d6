#pragma once
/// Tells the registry of every built-in payload.

#include "engine/api/registry.h"

namespace vinerow::vehicles {

void register_payloads(Registry& registry);

}  // namespace vinerow::vehicles
