#pragma once
/// Light of sky and sun for a given sun elevation.
///
/// Source: T. Nishita, T. Sirai, K. Tadamura, E. Nakamae, "Display of the earth taking into account
/// atmospheric scattering", SIGGRAPH 1993: single scattering by air (Rayleigh) and haze (Mie), with
/// scale heights of 8.0 and 1.2 km. Changed: one isotropic share of the single-scattered light is
/// added for the orders above the first, which matter most near the horizon.
/// Units: radiance and irradiance relative to the sun's irradiance above the atmosphere (= 1 per
/// colour channel), so the renderer's exposure gives them a scale.

#include <Eigen/Core>
#include <vector>

namespace vinerow::render {

struct Atmosphere {
  static constexpr int kAzimuths = 48;    ///< relative to the sun, 0 .. pi
  static constexpr int kElevations = 48;  ///< elevation = (i / (n-1))^2 * pi/2

  std::vector<Eigen::Vector3f> sky;  ///< radiance, kElevations x kAzimuths, azimuth fastest
  Eigen::Vector3f sun_irradiance;    ///< on a surface that faces the sun
  Eigen::Vector3f sky_irradiance;    ///< on level ground, without the sun
  Eigen::Vector3f horizon_to_sun;    ///< mean radiance low above the horizon below the sun
  Eigen::Vector3f horizon_from_sun;  ///< and on the opposite side
};

/// @param sun_elevation_rad  clamped to at least 2 deg: there is no night here
Atmosphere calc_atmosphere(double sun_elevation_rad);

}  // namespace vinerow::render
