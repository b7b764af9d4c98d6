#pragma once
/// Wind field common to all vehicles: mean wind by the height law, and listed gusts. Turbulence,
/// random gusts and shelter are computed for each vehicle (vehicles/parts/wind_probe.h). Formulae:
/// docs/models/wind.md.

#include <Eigen/Core>

#include "engine/api/wind.h"

namespace vinerow {

/// Unit vector in which a wind from this azimuth (clockwise from north) blows; x east, y north.
Eigen::Vector2d downwind_direction(double from_azimuth_rad);

/// Mean wind at a height above the ground without shelter, m/s; < 0 only with the linear law. Below
/// the roughness length (logarithmic) or the ground (power) it is 0, below the ground (linear) its
/// value at the ground; the uniform law ignores height.
double mean_wind_mps(const Wind& wind, double height_m);

/// Pulse (1 - cos(2 pi t / duration)) / 2 of a gust, 0 to 1; 0 outside. A gust with a front is
/// delayed by the travel time from W's origin along its direction.
/// @param wind  of which the gust is a part
double gust_pulse(const Wind& wind, const WindGust& gust, double time_s,
                  const Eigen::Vector2d& p_W);

/// Wind of a gust in W, m/s.
Eigen::Vector3d calc_gust_W(const Wind& wind, const WindGust& gust, double time_s,
                            const Eigen::Vector2d& p_W);

}  // namespace vinerow
