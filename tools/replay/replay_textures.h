#pragma once
/// Textures of leaves and ground from the renderer, for drawing in a replay.

#include <nlohmann/json.hpp>
#include <string>

#include "engine/api/world_model.h"

namespace vinerow::tools {

struct ReplayTextures {
  /// By name {"offset", "size", "channels", "levels"}, square, row 0 first; further levels, each
  /// half the size, follow:
  ///   leaf, spray, clump  brightness (128: unchanged leaf colour) and coverage; the stem is at the
  ///                       last row of v
  ///   ground              grass, dryness, soil, height of a tile of 2.1 m
  ///   noise               four noises that tile
  ///   sky                 roots of radiance / 2 as RGB; azimuth from the sun along a row, root of
  ///                       elevation / 90 deg along a column
  nlohmann::json index;
  std::string bytes;
};

ReplayTextures make_replay_textures(const Daylight& daylight);

/// Light of the renderer for this daylight: "sun_W" (unit vector towards the sun), "sun", "sky",
/// "ground" (linear RGB of a white surface that faces each), "haze_to_sun", "haze_from_sun".
nlohmann::json replay_light(const Daylight& daylight);

}  // namespace vinerow::tools
