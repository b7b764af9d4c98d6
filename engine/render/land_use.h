#pragma once
/// Ground textures with the fields and tracks of the scenery.

#include <Eigen/Geometry>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scenery.h"
#include "engine/imaging/pixels.h"

namespace vinerow::render {

struct LandUse {
  static constexpr double kReach_m = 5.1;  ///< distances to tracks are stored up to here

  Eigen::Vector2d corner_W = {0, 0};
  Eigen::Vector2d size_m = {1, 1};
  imaging::Pixels pixels;  ///< R number of the field at or next to the pixel, 0: none; G distance
                           ///< to the middle of a track / 5.1 m; B 128 in a field, 255 in its rows;
                           ///< A shade of trees; row 0 is south
  /// Three texels of four numbers per field: normal of its rows (2), their offset along it and
  /// pitch (0: no rows); dryness, tilled, stubble, brightness; half width, foot and top of rows, 0.
  std::vector<float> table;
};

/// Covers the terrain; sizes are powers of two up to 2048. @param sun_W  unit, towards the sun
LandUse make_land_use(const Scenery& scenery, const HeightField& terrain,
                      const Eigen::Vector3d& sun_W);

}  // namespace vinerow::render
