#pragma once
/// Soils by name.

#include <string>
#include <vector>

#include "engine/api/soil.h"

namespace vinerow::worlds {

/// Names of the built-in soils.
std::vector<std::string> soil_names();

/// @throws ConfigError naming the known soils
Soil find_soil(const std::string& name);

}  // namespace vinerow::worlds
