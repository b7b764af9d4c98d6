#pragma once
/// Light of the scene by the sun's position and the clouds, in the scale of atmosphere.h.
///
/// **Clouds.** F. Kasten, G. Czeplak, "Solar and terrestrial radiation dependent on the amount and
/// type of cloud", Solar Energy 24, 1980: of the light on level ground a cloud cover N leaves the
/// share k = 1 - 0.75 N^3.4, and the part of it that comes from the sky grows with N^2 up to all of
/// it. With the sun's irradiance E on a surface facing it, its height s = sin(elevation), and the
/// irradiance D of the clear sky:
///
///   E(N) = (1 - N^2) k E        D(N) = k D + N^2 k s E
///
/// The share 1 - N of the sky still shows its blue; the rest of D(N) comes from the clouds. Their
/// radiance grows from the horizon to three times as much at the zenith (overcast sky of CIE S
/// 011). Clouds have no shapes: a cover of one half is a veil over all the sky.

#include <Eigen/Core>

#include "engine/api/world_model.h"
#include "engine/imaging/atmosphere.h"

namespace vinerow::imaging {

struct SceneLight {
  Eigen::Vector3d sun_direction_W;  ///< unit, towards the sun
  Atmosphere atmosphere;            ///< its sky with the clouds
  Eigen::Vector3d sun_irradiance;
  Eigen::Vector3d sky_irradiance;                              ///< with the clouds
  Eigen::Vector3d cloud_irradiance = Eigen::Vector3d::Zero();  ///< part of it, from the clouds
  Eigen::Vector3d ground_irradiance;  ///< reflected by sunlit ground onto downward faces
  double exposure = 1.0;              ///< factor from radiance to the input of the tone curve
};

SceneLight make_light(const Daylight& daylight);

/// Radiance of the clouds. @param sin_elevation  of the direction, in [0, 1]
Eigen::Vector3d cloud_radiance(const SceneLight& light, double sin_elevation);

}  // namespace vinerow::imaging
