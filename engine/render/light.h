#pragma once
/// The scene's light in the renderer's own scale, from the time of day.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/render/atmosphere.h"

namespace vinerow::render {

struct Light {
  Eigen::Vector3d sun_direction_W;  ///< unit, towards the sun
  Atmosphere atmosphere;
  Eigen::Vector3d sun_irradiance;
  Eigen::Vector3d sky_irradiance;
  Eigen::Vector3d ground_irradiance;  ///< thrown back by sunlit ground onto downward faces
  double exposure = 1.0;              ///< radiance -> scene value that the tone curve takes
};

inline Light make_light(const Daylight& daylight) {
  Light light;
  const double elevation = std::max(daylight.sun_elevation_rad, 0.035);
  const double azimuth = daylight.sun_azimuth_rad;  // from north, clockwise
  light.sun_direction_W = {std::sin(azimuth) * std::cos(elevation),
                           std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  light.atmosphere = calc_atmosphere(elevation);
  light.sun_irradiance = light.atmosphere.sun_irradiance.cast<double>();
  // Clouds and the light that leaves and walls throw at each other add a whitish half to what the
  // clear sky gives.
  const Eigen::Vector3d clear = light.atmosphere.sky_irradiance.cast<double>();
  light.sky_irradiance = 1.35 * clear + 0.055 * light.sun_irradiance;
  const Eigen::Vector3d ground_albedo(0.14, 0.13, 0.07);
  light.ground_irradiance = ground_albedo.cwiseProduct(
      light.sun_irradiance * light.sun_direction_W.z() + light.sky_irradiance);
  // A white card that half faces the sun comes out at 1, whatever the hour.
  const Eigen::Vector3d luminance(0.2126, 0.7152, 0.0722);
  const double key =
      luminance.dot(light.sun_irradiance) * (0.35 + 0.65 * light.sun_direction_W.z()) +
      luminance.dot(light.sky_irradiance);
  light.exposure = 1.15 * 3.14159265 / key;
  return light;
}

}  // namespace vinerow::render
