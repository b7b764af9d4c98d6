#pragma once
/// The Earth's main magnetic field by the World Magnetic Model 2025 (NOAA/NCEI and British
/// Geological Survey, degree and order 12, in the public domain). Crust, ground currents and
/// magnetic storms, tenths of a microtesla, are not in it.

#include <Eigen/Core>

namespace vinerow {

/// Years for which the model was made.
inline constexpr double kFirstGeomagneticYear = 2025.0;
inline constexpr double kLastGeomagneticYear = 2030.0;

/// Flux density at a place, T: east, north, up at WGS84's normal. At the poles, where east means
/// nothing, that of a place 0.6 m beside them on the same meridian.
/// @param altitude_m  above the ellipsoid
/// @param year        decimal; outside the model's years its trend is continued
Eigen::Vector3d calc_geomagnetic_field_T(double latitude_rad, double longitude_rad,
                                         double altitude_m, double year);

}  // namespace vinerow
