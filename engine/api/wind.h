#pragma once
/// The wind of a world, as plain data. What a vehicle feels of it, vehicles/parts/wind_probe.h
/// works out: mean wind by a height law, Dryden turbulence, 1-cosine gusts, shelter between the
/// vines.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow {

/// How the mean wind grows with height.
enum class WindHeightLaw {
  kUniform,      ///< the same everywhere
  kLogarithmic,  ///< u(z) = u_ref ln(z / z0) / ln(z_ref / z0)
  kPower,        ///< u(z) = u_ref (z / z_ref)^exponent
  kLinear        ///< from u_ground at the ground to u_ref at z_ref, and on like that above
};

/// How dense the air is.
enum class Atmosphere {
  kConstant,   ///< air_density_kgm3 everywhere, or the standard's at the origin's altitude
  kStandard76  ///< US Standard Atmosphere 1976 at the altitude above the ellipsoid
};

/// A single pulse 1/2 amplitude (1 - cos(2 pi t / duration)).
struct WindGust {
  double start_s = 0.0;
  double duration_s = 2.0;
  double amplitude_mps = 0.0;  ///< at the middle of the pulse; horizontal
  /// Where it comes from, clockwise from north; absent: as the mean wind.
  std::optional<double> from_azimuth_rad = std::nullopt;
  double vertical_mps = 0.0;  ///< its part along +z, with the same pulse
  /// Speed of the front in the gust's direction: it is at W's origin at start_s, earlier upwind
  /// and later downwind. 0: everywhere at once.
  double front_speed_mps = 0.0;
};

/// Gusts that come at random times, from any side.
struct GustStatistics {
  double interval_s = 60.0;    ///< mean time from start to start; more than duration_s
  double amplitude_mps = 1.0;  ///< at the middle of the pulse; horizontal
  double duration_s = 2.0;     ///< from calm to calm
  std::uint64_t seed = 0;      ///< of their schedule: the run's
};

struct Wind {
  Atmosphere atmosphere = Atmosphere::kConstant;
  /// With Atmosphere::kConstant; absent: that of the standard atmosphere where W's origin is.
  std::optional<double> air_density_kgm3 = std::nullopt;
  double mean_speed_mps = 0.0;    ///< at reference_height_m above the ground
  double from_azimuth_rad = 0.0;  ///< where it comes from, clockwise from north
  double reference_height_m = 10.0;
  WindHeightLaw height_law = WindHeightLaw::kLogarithmic;
  double roughness_length_m = 0.1;
  double power_exponent = 0.2;
  double ground_speed_mps = 0.0;  ///< of the linear law, at the ground; < 0: the other way
  /// Scales the standard deviations of the Dryden turbulence (MIL-F-8785C, low altitude); 0: none.
  double turbulence = 0.0;
  /// Wind at 20 ft that sets them, m/s; absent: what the mean wind has at that height.
  std::optional<double> turbulence_wind_mps = std::nullopt;
  /// Largest length of the turbulence's vector: what is beyond is cut to it; 0: no limit.
  double turbulence_limit_mps = 0.0;
  std::vector<WindGust> gusts;
  std::optional<GustStatistics> random_gusts = std::nullopt;
  /// Between the rows and below the canopy's top the wind is that at the top times
  /// exp(-attenuation (1 - z / top)) across the rows, less attenuated along them; 0: no shelter.
  double shelter_attenuation = 0.0;

  bool calm() const {
    const bool still_ground = height_law != WindHeightLaw::kLinear || ground_speed_mps == 0.0;
    return mean_speed_mps == 0.0 && still_ground &&
           (turbulence == 0.0 || turbulence_wind_mps.value_or(0.0) == 0.0) && gusts.empty() &&
           !random_gusts;
  }
};

/// The group `wind` of worlds: keys, ranges, words, and the rules of what fits together.
const ParameterTable<Wind>& wind_table();

/// @throws ConfigError "wind: roughness_length_m = 12 m, must be < reference_height_m = 10 m" and
/// the like: one sentence with key, value and what is allowed.
void validate(const Wind& wind);

}  // namespace vinerow
