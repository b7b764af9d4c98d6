#pragma once
/// Checks of parameter structs, one sentence each: "rover: mass_kg = -2, must be > 0".

#include <string>

namespace vinerow::vehicles {

/// @throws ConfigError unless value is finite and > 0
void demand_positive(const std::string& who, const char* field, double value);
/// @throws ConfigError unless value is finite and >= 0
void demand_not_negative(const std::string& who, const char* field, double value);
/// @throws ConfigError unless value is finite and inside [min, max]
void demand_range(const std::string& who, const char* field, double value, double min, double max);

}  // namespace vinerow::vehicles
