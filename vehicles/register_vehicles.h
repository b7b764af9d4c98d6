#pragma once
/// The built-in vehicles, one line each in register_vehicles.cpp.

#include "engine/api/registry.h"

namespace vinerow::vehicles {

void register_vehicles(Registry& registry);

}  // namespace vinerow::vehicles
