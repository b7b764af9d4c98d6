#pragma once
/// Sky and sun light for a given sun elevation.
///
/// Source: T. Nishita, T. Sirai, K. Tadamura, E. Nakamae, "Display of the earth taking into account
/// atmospheric scattering", SIGGRAPH 1993: single scattering by air (Rayleigh) and haze (Mie), with
/// scale heights of 8.0 and 1.2 km. Difference from the source: an isotropic share of the
/// single-scattered light is added for higher scattering orders, which matter most near the
/// horizon.
/// Units: radiance and irradiance relative to the sun's irradiance above the atmosphere (= 1 per
/// colour channel), so the renderer's exposure defines their scale.

#include <Eigen/Core>
#include <vector>

namespace vinerow::imaging {

struct Atmosphere {
  static constexpr int kAzimuths = 48;    ///< relative to the sun, 0 .. pi
  static constexpr int kElevations = 48;  ///< elevation = (i / (n-1))^2 * pi/2

  std::vector<Eigen::Vector3f> sky;  ///< radiance, kElevations x kAzimuths, azimuth fastest
  Eigen::Vector3f sun_irradiance;    ///< on a surface facing the sun
  Eigen::Vector3f sky_irradiance;    ///< on level ground, without the sun
  Eigen::Vector3f horizon_to_sun;    ///< mean radiance just above the horizon, towards the sun
  Eigen::Vector3f horizon_from_sun;  ///< the same, away from the sun
};

/// @param sun_elevation_rad  clamped to at least 2 deg; night is not modelled
Atmosphere calc_atmosphere(double sun_elevation_rad);

}  // namespace vinerow::imaging
