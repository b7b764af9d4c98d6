#pragma once
/// The parameter group `wind` that all built-in worlds share. What its numbers do: docs/wind.md.

#include <cstdint>

#include "engine/api/parameters.h"
#include "engine/api/wind.h"

namespace vinerow::worlds {

/// The group `wind`: `mean_speed_mps`, `from_deg`, `reference_height_m`, `height_law`,
/// `roughness_length_m`, `power_exponent`, `ground_speed_mps`, `turbulence`, `turbulence_wind_mps`,
/// `turbulence_limit_mps`, `gusts`, `random_gusts`, `shelter`, `atmosphere`, `air_density_kgm3`.
/// Absent: calm.
ParameterSpec wind_parameter();

/// @param parameters  with wind_parameter()
/// @param seed  of the run: gusts by chance follow from it
/// @throws ConfigError as validate(Wind)
Wind read_wind(const ParameterSet& parameters, std::uint64_t seed);

}  // namespace vinerow::worlds
