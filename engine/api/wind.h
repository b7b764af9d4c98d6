#pragma once
/// Wind of a world, as plain data. vehicles/parts/wind_probe.h computes the wind that a vehicle
/// feels: mean wind by a height law, Dryden turbulence, 1-cosine gusts, shelter between the vines.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow {

/// Profile of the mean wind over height.
enum class WindHeightLaw {
  kUniform,      ///< the same everywhere
  kLogarithmic,  ///< u(z) = u_ref ln(z / z0) / ln(z_ref / z0)
  kPower,        ///< u(z) = u_ref (z / z_ref)^exponent
  kLinear        ///< linear from u_ground at the ground to u_ref at z_ref, and beyond
};

/// Model of the air density.
enum class Atmosphere {
  kConstant,   ///< air_density_kgm3 everywhere, or the standard's at the origin's altitude
  kStandard76  ///< US Standard Atmosphere 1976 at the altitude above the ellipsoid
};

/// Single gust: a pulse 1/2 amplitude (1 - cos(2 pi t / duration)).
struct WindGust {
  double start_s = 0.0;
  double duration_s = 2.0;
  double amplitude_mps = 0.0;  ///< at the middle of the pulse; horizontal
  /// Azimuth from which the gust comes, clockwise from north; absent: that of the mean wind.
  std::optional<double> from_azimuth_rad = std::nullopt;
  double vertical_mps = 0.0;  ///< component along +z, with the same pulse
  /// Speed of the gust front in the gust's direction: the front is at W's origin at start_s,
  /// earlier upwind and later downwind. 0: the gust is everywhere at once.
  double front_speed_mps = 0.0;
};

/// Gusts at random times from random directions.
struct GustStatistics {
  double interval_s = 60.0;    ///< mean time between starts; more than duration_s
  double amplitude_mps = 1.0;  ///< at the middle of the pulse; horizontal
  double duration_s = 2.0;     ///< length of a pulse
  std::uint64_t seed = 0;      ///< of the schedule; the run's seed
};

struct Wind {
  Atmosphere atmosphere = Atmosphere::kConstant;
  /// For Atmosphere::kConstant; absent: density of the standard atmosphere at W's origin.
  std::optional<double> air_density_kgm3 = std::nullopt;
  double mean_speed_mps = 0.0;    ///< at reference_height_m above the ground
  double from_azimuth_rad = 0.0;  ///< azimuth from which the wind comes, clockwise from north
  double reference_height_m = 10.0;
  WindHeightLaw height_law = WindHeightLaw::kLogarithmic;
  double roughness_length_m = 0.1;
  double power_exponent = 0.2;
  double ground_speed_mps = 0.0;  ///< of the linear law, at the ground; < 0: opposite direction
  /// Scales the standard deviations of the Dryden turbulence (MIL-F-8785C, low altitude); 0: none.
  double turbulence = 0.0;
  /// Wind at 20 ft that scales the turbulence, m/s; absent: the mean wind at that height.
  std::optional<double> turbulence_wind_mps = std::nullopt;
  /// Maximum length of the turbulence vector; longer vectors are cut to it. 0: no limit.
  double turbulence_limit_mps = 0.0;
  std::vector<WindGust> gusts;
  std::optional<GustStatistics> random_gusts = std::nullopt;
  /// Between the rows and below the canopy top the wind is the wind at the top times
  /// exp(-attenuation (1 - z / top)) across the rows, with less attenuation along them; 0: no
  /// shelter.
  double shelter_attenuation = 0.0;
  /// The world computes shelter_attenuation from the leaf area of its plants.
  bool shelter_by_leaves = false;

  bool calm() const {
    const bool still_ground = height_law != WindHeightLaw::kLinear || ground_speed_mps == 0.0;
    return mean_speed_mps == 0.0 && still_ground &&
           (turbulence == 0.0 || turbulence_wind_mps.value_or(0.0) == 0.0) && gusts.empty() &&
           !random_gusts;
  }
};

/// Parameter group `wind` of worlds: keys, ranges, descriptions and consistency rules.
const ParameterTable<Wind>& wind_table();

/// @throws ConfigError "wind: roughness_length_m = 12 m, must be < reference_height_m = 10 m" and
/// similar: one sentence with key, value and what is allowed
void validate(const Wind& wind);

}  // namespace vinerow
