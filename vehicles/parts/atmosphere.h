#pragma once
/// US Standard Atmosphere 1976 (NASA TM-X-74335): density up to 86 km. The altitude above the
/// ellipsoid is taken for that above mean sea level.

namespace vinerow::vehicles {

/// Geopotential height of a geometric one with the standard's earth radius of 6356.766 km, m.
double geopotential_height_m(double altitude_m);

/// kg/m3. Below -5 km and above 86 km the values at these altitudes hold.
double calc_standard_density_kgm3(double altitude_m);

}  // namespace vinerow::vehicles
