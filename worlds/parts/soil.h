#pragma once
/// Soils by name.

#include <string>
#include <vector>

#include "engine/api/parameters.h"
#include "engine/api/soil.h"

namespace vinerow::worlds {

/// Names of the built-in soils.
std::vector<std::string> soil_names();

/// @throws ConfigError naming the known soils
Soil find_soil(const std::string& name);

/// `soil`: choice of the built-in soils.
ParameterSpec soil_parameter(const std::string& default_name);

}  // namespace vinerow::worlds
