#include "engine/imaging/daylight.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::imaging {
namespace {

/// Dims sun and clear sky, and adds the clouds' light to the sky.
void cover_with_clouds(double cover, SceneLight& light) {
  const double left = 1.0 - 0.75 * std::pow(cover, 3.4);
  const Eigen::Vector3d clear_sky = light.sky_irradiance;
  const Eigen::Vector3d level_sun = light.sun_direction_W.z() * light.sun_irradiance;
  light.sun_irradiance *= (1.0 - cover * cover) * left;
  light.sky_irradiance = left * (clear_sky + cover * cover * level_sun);
  light.cloud_irradiance = light.sky_irradiance - (1.0 - cover) * clear_sky;

  const auto veil = [&](Eigen::Vector3f& radiance, double sin_elevation) {
    radiance = (static_cast<float>(1.0 - cover) * radiance.cast<double>() +
                cloud_radiance(light, sin_elevation))
                   .cast<float>();
  };
  Atmosphere& air = light.atmosphere;
  for (int i = 0; i < Atmosphere::kElevations; ++i) {
    const double share = static_cast<double>(i) / (Atmosphere::kElevations - 1);
    const double sin_elevation = std::sin(0.5 * kPi * share * share);
    for (int k = 0; k < Atmosphere::kAzimuths; ++k) {
      veil(air.sky[static_cast<std::size_t>(i * Atmosphere::kAzimuths + k)], sin_elevation);
    }
  }
  veil(air.horizon_to_sun, 0.0);
  veil(air.horizon_from_sun, 0.0);
}

}  // namespace

SceneLight make_light(const Daylight& daylight) {
  SceneLight light;
  const double elevation = std::max(daylight.sun_elevation_rad, 0.035);
  const double azimuth = daylight.sun_azimuth_rad;  // from north, clockwise
  light.sun_direction_W = {std::sin(azimuth) * std::cos(elevation),
                           std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  light.atmosphere = calc_atmosphere(elevation);
  light.sun_irradiance = light.atmosphere.sun_irradiance.cast<double>();
  // Haze and light reflected between leaves and walls add about half of the clear sky's light,
  // nearly white.
  const Eigen::Vector3d clear = light.atmosphere.sky_irradiance.cast<double>();
  light.sky_irradiance = 1.35 * clear + 0.055 * light.sun_irradiance;
  if (daylight.cloud_cover > 0.0) cover_with_clouds(daylight.cloud_cover, light);
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

Eigen::Vector3d cloud_radiance(const SceneLight& light, double sin_elevation) {
  // Over the hemisphere (1 + 2 sin e) / 3 times the zenith's radiance gives 7 pi / 9 of it.
  const Eigen::Vector3d zenith = 9.0 / (7.0 * kPi) * light.cloud_irradiance;
  return (1.0 + 2.0 * sin_elevation) / 3.0 * zenith;
}

}  // namespace vinerow::imaging
