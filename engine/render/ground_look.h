#pragma once
/// How the ground looks that wheels feel.

#include <Eigen/Core>

#include "engine/api/soil.h"

namespace vinerow::render {

/// Against dry grass, of which the textures are made.
struct GroundLook {
  Eigen::Vector3f soil_tint = {1, 1, 1};  ///< bare soil's colour is multiplied by it
  float bare = 0.0f;                      ///< share of the ground without grass, 0 to 1
  float grass_brightness = 1.0f;
  float grass_dryness = 0.0f;  ///< added to the grass's own: below 0 greener
};

/// By the soil's name; of one that is not built in that of dry grass.
GroundLook look_of(const Soil& soil);

}  // namespace vinerow::render
