#pragma once
/// Pictures of leaves and ground, as the renderer has them, for a replay's own drawing.

#include <nlohmann/json.hpp>
#include <string>

#include "engine/api/world_model.h"

namespace vinerow::tools {

struct ReplayTextures {
  /// By name {"offset", "size", "channels", "levels"}, square, row 0 first; further levels, each
  /// half the size, follow:
  ///   leaf, spray, clump  brightness (128: the leaf's own green) and coverage; the stem is at the
  ///                       last row of v
  ///   ground              grass, dryness, soil, height of a tile of 2.1 m
  ///   noise               four noises that tile
  ///   sky                 roots of radiance / 2 as RGB; azimuth from the sun along a row, root of
  ///                       elevation / 90 deg along a column
  nlohmann::json index;
  std::string bytes;
};

ReplayTextures make_replay_textures(const Daylight& daylight);

/// Light of the renderer at that hour: "sun_W" (unit, towards it), "sun", "sky", "ground" (linear
/// RGB of a white surface that faces each), "haze_to_sun", "haze_from_sun".
nlohmann::json replay_light(const Daylight& daylight);

}  // namespace vinerow::tools
