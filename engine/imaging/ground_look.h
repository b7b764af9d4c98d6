#pragma once
/// Appearance of the ground by soil.

#include <Eigen/Core>

#include "engine/api/soil.h"

namespace vinerow::imaging {

/// Appearance relative to dry grass, for which the textures are made.
struct GroundLook {
  Eigen::Vector3f soil_tint = {1, 1, 1};  ///< factor on the colour of bare soil
  float bare = 0.0f;                      ///< share of the ground without grass, 0 to 1
  float grass_brightness = 1.0f;
  float grass_dryness = 0.0f;  ///< added to the grass's own; greener if negative
};

/// Appearance by the soil's name; that of dry grass for soils that are not built in.
GroundLook look_of(const Soil& soil);

}  // namespace vinerow::imaging
