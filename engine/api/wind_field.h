#pragma once
/// What everybody feels of a world's wind at a place and time: mean wind by the height law, and
/// listed gusts. Turbulence, gusts by chance and shelter are a vehicle's own
/// (vehicles/parts/wind_probe.h). Formulae: docs/models/wind.md.

#include <Eigen/Core>

#include "engine/api/wind.h"

namespace vinerow {

/// Unit vector to which a wind from this azimuth (clockwise from north) blows; x east, y north.
Eigen::Vector2d downwind_direction(double from_azimuth_rad);

/// Mean wind at a height above the ground without shelter, m/s; < 0 only by the linear law.
/// Continues as 0 below the roughness length (logarithmic) or the ground (power), as on the ground
/// below it (linear); uniform has no ground.
double mean_wind_mps(const Wind& wind, double height_m);

/// Pulse (1 - cos(2 pi t / duration)) / 2 of a gust, 0 to 1; 0 outside. A gust with a front is
/// late by the way from W's origin along its direction. @param wind  whose gust it is
double gust_pulse(const Wind& wind, const WindGust& gust, double time_s,
                  const Eigen::Vector2d& p_W);

/// Its wind in W, m/s.
Eigen::Vector3d calc_gust_W(const Wind& wind, const WindGust& gust, double time_s,
                            const Eigen::Vector2d& p_W);

}  // namespace vinerow
