#include "tools/replay/replay_textures.h"

#include <algorithm>
#include <cmath>

#include "engine/imaging/daylight.h"
#include "engine/render/builtin_textures.h"

namespace vinerow::tools {
namespace {

using imaging::Pixels;
using nlohmann::json;

constexpr int kCardSize = 128;
constexpr int kTileSize = 256;

/// Levels from the first that is at most `size` wide.
std::vector<Pixels> levels_from(std::vector<Pixels> levels, int size) {
  const auto found = std::find_if(levels.begin(), levels.end(),
                                  [&](const Pixels& level) { return level.width <= size; });
  return {found, levels.end()};
}

void add_texture(ReplayTextures& textures, const std::string& name,
                 const std::vector<Pixels>& levels, const std::vector<int>& channels) {
  textures.index[name] = {{"offset", textures.bytes.size()},
                          {"size", levels.front().width},
                          {"levels", levels.size()},
                          {"channels", channels.size()}};
  for (const Pixels& pixels : levels) {
    for (int i = 0; i < pixels.width * pixels.height; ++i) {
      for (const int c : channels) {
        textures.bytes += static_cast<char>(pixels.rgba[4 * static_cast<std::size_t>(i) + c]);
      }
    }
  }
}

json array_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

ReplayTextures make_replay_textures(const Daylight& daylight) {
  ReplayTextures textures;
  const std::pair<const char*, int> pictures[] = {
      {"leaf", render::kLeafSingle}, {"spray", render::kLeafSpray}, {"clump", render::kLeafClump}};
  for (const auto& [name, layer] : pictures) {
    const Pixels& card = render::card_texture(layer);
    add_texture(textures, name, levels_from(imaging::mip_chain_with_coverage(card), kCardSize),
                {0, 3});
  }
  const std::pair<const char*, const Pixels&> tiles[] = {{"ground", render::ground_texture()},
                                                         {"noise", render::noise_texture()}};
  for (const auto& [name, tile] : tiles) {
    add_texture(textures, name, {levels_from(imaging::mip_chain(tile), kTileSize).front()},
                {0, 1, 2, 3});
  }

  const imaging::SceneLight light = imaging::make_light(daylight);
  static_assert(imaging::Atmosphere::kAzimuths == imaging::Atmosphere::kElevations);
  Pixels sky(imaging::Atmosphere::kAzimuths, imaging::Atmosphere::kElevations);
  for (std::size_t i = 0; i < light.atmosphere.sky.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double exposed = light.exposure * light.atmosphere.sky[i][c];
      sky.rgba[4 * i + c] = static_cast<std::uint8_t>(
          std::lround(255.0 * std::sqrt(std::clamp(0.5 * exposed, 0.0, 1.0))));
    }
  }
  add_texture(textures, "sky", {sky}, {0, 1, 2});
  return textures;
}

json replay_light(const Daylight& daylight) {
  const imaging::SceneLight light = imaging::make_light(daylight);
  const double scale = light.exposure / EIGEN_PI;  // a diffuse white surface
  return {
      {"sun_W", array_of(light.sun_direction_W)},
      {"sun", array_of(scale * light.sun_irradiance)},
      {"sky", array_of(scale * light.sky_irradiance)},
      {"ground", array_of(scale * light.ground_irradiance)},
      {"haze_to_sun", array_of(light.exposure * light.atmosphere.horizon_to_sun.cast<double>())},
      {"haze_from_sun",
       array_of(light.exposure * light.atmosphere.horizon_from_sun.cast<double>())}};
}

}  // namespace vinerow::tools
