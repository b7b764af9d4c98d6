#pragma once
/// Earth's main magnetic field by the World Magnetic Model 2025 (NOAA/NCEI and British Geological
/// Survey, degree and order 12, in the public domain). It excludes crust, ground currents and
/// magnetic storms, which are tenths of a microtesla.

#include <Eigen/Core>

namespace vinerow {

/// Validity range of the model, years.
inline constexpr double kFirstGeomagneticYear = 2025.0;
inline constexpr double kLastGeomagneticYear = 2030.0;

/// Flux density, T: east, north, and up along WGS84's normal. At the poles, where east is
/// undefined, the field is that of a point 0.6 m away on the same meridian.
/// @param altitude_m  above the ellipsoid
/// @param year        decimal; outside the model's years its trend is extrapolated
Eigen::Vector3d calc_geomagnetic_field_T(double latitude_rad, double longitude_rad,
                                         double altitude_m, double year);

}  // namespace vinerow
