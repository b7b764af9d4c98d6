#pragma once
/// US Standard Atmosphere 1976 (NASA TM-X-74335) up to 86 km. The altitude above the ellipsoid is
/// used as altitude above mean sea level. Below -5 km and above 86 km the values at these altitudes
/// hold.

namespace vinerow {

/// Static pressure at mean sea level, Pa.
inline constexpr double kSeaLevelPressure_Pa = 101'325.0;

/// Geopotential height of a geometric altitude with the standard's earth radius of 6356.766 km, m.
double geopotential_height_m(double altitude_m);

struct AirState {
  double pressure_Pa = 0.0;
  double temperature_K = 0.0;
  double density_kgm3 = 0.0;
};
/// @param altitude_m  geometric
AirState calc_standard_air(double altitude_m);

/// The density alone, kg/m3.
double calc_standard_density_kgm3(double altitude_m);

}  // namespace vinerow
