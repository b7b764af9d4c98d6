#pragma once
/// The wind of a world, as plain data. What a vehicle feels of it, vehicles/parts/wind_probe.h
/// works out: mean wind by a height law, Dryden turbulence, 1-cosine gusts, shelter between the
/// vines.

#include <cstdint>
#include <vector>

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
  kConstant,   ///< air_density_kgm3 everywhere
  kStandard76  ///< US Standard Atmosphere 1976 at the altitude above the ellipsoid
};

/// A single pulse 1/2 amplitude (1 - cos(2 pi t / duration)).
struct WindGust {
  double start_s = 0.0;
  double duration_s = 2.0;
  double amplitude_mps = 0.0;     ///< at the middle of the pulse; horizontal
  double from_azimuth_rad = 0.0;  ///< where it comes from, clockwise from north
  double vertical_mps = 0.0;      ///< its part along +z, with the same pulse
  /// Speed of the front in the gust's direction: it is at W's origin at start_s, earlier upwind
  /// and later downwind. 0: everywhere at once.
  double front_speed_mps = 0.0;
};

struct Wind {
  Atmosphere atmosphere = Atmosphere::kConstant;
  double air_density_kgm3 = 1.225;  ///< with Atmosphere::kConstant
  double mean_speed_mps = 0.0;      ///< at reference_height_m above the ground
  double from_azimuth_rad = 0.0;    ///< where it comes from, clockwise from north
  double reference_height_m = 10.0;
  WindHeightLaw height_law = WindHeightLaw::kLogarithmic;
  double roughness_length_m = 0.1;
  double power_exponent = 0.2;
  double ground_speed_mps = 0.0;  ///< of the linear law, at the ground; < 0: the other way
  /// Scales the standard deviations of the Dryden turbulence (MIL-F-8785C, low altitude); 0: none.
  double turbulence = 0.0;
  /// Wind at 20 ft that sets them, m/s; < 0: what the mean wind has at that height.
  double turbulence_wind_mps = -1.0;
  /// Largest length of the turbulence's vector: what is beyond is cut to it; 0: no limit.
  double turbulence_limit_mps = 0.0;
  std::vector<WindGust> gusts;
  /// Gusts that come by chance: one per this time on average, s, from any side; 0: none.
  double random_gust_interval_s = 0.0;
  double random_gust_amplitude_mps = 1.0;
  double random_gust_duration_s = 2.0;
  std::uint64_t random_gust_seed = 0;  ///< of their schedule: the run's
  /// Between the rows and below the canopy's top the wind is that at the top times
  /// exp(-attenuation (1 - z / top)) across the rows, less attenuated along them; 0: no shelter.
  double shelter_attenuation = 0.0;

  bool calm() const {
    const bool still_ground = height_law != WindHeightLaw::kLinear || ground_speed_mps == 0.0;
    return mean_speed_mps == 0.0 && still_ground &&
           (turbulence == 0.0 || turbulence_wind_mps <= 0.0) && gusts.empty() &&
           random_gust_interval_s == 0.0;
  }
};

/// @throws ConfigError "wind.roughness_length_m = 12 m, must be < wind.reference_height_m = 10 m"
/// and the like: one sentence with key, value and what is allowed.
void validate(const Wind& wind);

}  // namespace vinerow
