#pragma once
/// The parameter group `wind` that all built-in worlds share. What its numbers do: docs/wind.md.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/wind.h"

namespace vinerow::worlds {

struct WindParams {
  struct Gust {
    WindGust gust;
    std::optional<double> from_azimuth_rad;  ///< absent: as the mean wind
  };
  struct RandomGusts {
    double interval_s = 60.0;  ///< mean time from gust to gust, more than duration_s
    double amplitude_mps = Wind{}.random_gust_amplitude_mps;
    double duration_s = Wind{}.random_gust_duration_s;
  };

  Wind wind;  ///< without gusts and the wind at 20 ft
  std::optional<double> turbulence_wind_mps;
  std::vector<Gust> gusts;
  std::optional<RandomGusts> random_gusts;
};

/// `mean_speed_mps`, `from_deg`, `reference_height_m`, `height_law`, `roughness_length_m`,
/// `power_exponent`, `ground_speed_mps`, `turbulence`, `turbulence_wind_mps`,
/// `turbulence_limit_mps`, `gusts`, `random_gusts`, `shelter`, `atmosphere`, `air_density_kgm3`.
const ParameterTable<WindParams>& wind_table();

/// @param seed  of the run: gusts by chance follow from it
/// @throws ConfigError as validate(Wind)
Wind make_wind(const WindParams& params, std::uint64_t seed);

}  // namespace vinerow::worlds
