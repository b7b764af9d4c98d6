#pragma once
/// Registration of all built-in payloads.

#include "engine/api/registry.h"

namespace vinerow::vehicles {

void register_payloads(Registry& registry);

}  // namespace vinerow::vehicles
