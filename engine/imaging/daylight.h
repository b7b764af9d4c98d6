#pragma once
/// Light of the scene by the sun's position, in the scale of atmosphere.h.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/imaging/atmosphere.h"

namespace vinerow::imaging {

struct SceneLight {
  Eigen::Vector3d sun_direction_W;  ///< unit, towards the sun
  Atmosphere atmosphere;
  Eigen::Vector3d sun_irradiance;
  Eigen::Vector3d sky_irradiance;
  Eigen::Vector3d ground_irradiance;  ///< reflected by sunlit ground onto downward faces
  double exposure = 1.0;              ///< factor from radiance to the input of the tone curve
};

inline SceneLight make_light(const Daylight& daylight) {
  SceneLight light;
  const double elevation = std::max(daylight.sun_elevation_rad, 0.035);
  const double azimuth = daylight.sun_azimuth_rad;  // from north, clockwise
  light.sun_direction_W = {std::sin(azimuth) * std::cos(elevation),
                           std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  light.atmosphere = calc_atmosphere(elevation);
  light.sun_irradiance = light.atmosphere.sun_irradiance.cast<double>();
  // Clouds and light reflected between leaves and walls add about half of the clear sky's light,
  // nearly white.
  const Eigen::Vector3d clear = light.atmosphere.sky_irradiance.cast<double>();
  light.sky_irradiance = 1.35 * clear + 0.055 * light.sun_irradiance;
  const Eigen::Vector3d ground_albedo(0.14, 0.13, 0.07);
  light.ground_irradiance = ground_albedo.cwiseProduct(
      light.sun_irradiance * light.sun_direction_W.z() + light.sky_irradiance);
  // Exposure at which a white card half facing the sun has the value 1 at any hour.
  const Eigen::Vector3d luminance(0.2126, 0.7152, 0.0722);
  const double key =
      luminance.dot(light.sun_irradiance) * (0.35 + 0.65 * light.sun_direction_W.z()) +
      luminance.dot(light.sky_irradiance);
  light.exposure = 1.15 * 3.14159265 / key;
  return light;
}

}  // namespace vinerow::imaging
