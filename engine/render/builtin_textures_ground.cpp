#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/render/builtin_textures.h"
#include "engine/render/noise.h"

namespace vinerow::render {

namespace {

std::uint8_t byte(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

/// Grey planes for painting strokes; they wrap around at the edges.
struct GreyPlane {
  int size;
  std::vector<float> value;
  explicit GreyPlane(int n, float fill) : size(n), value(static_cast<std::size_t>(n) * n, fill) {}
  float& at(int x, int y) {
    return value[static_cast<std::size_t>(y & (size - 1)) * size + (x & (size - 1))];
  }
};

/// Paints blades of grass in all directions; later ones are lighter and higher.
void paint_grass(GreyPlane& brightness, GreyPlane& dryness, GreyPlane& height) {
  Scatter scatter(31);
  const int n = brightness.size;
  constexpr int kBlades = 11000;
  for (int i = 0; i < kBlades; ++i) {
    const float layer = static_cast<float>(i) / kBlades;
    float x = scatter.next() * static_cast<float>(n);
    float y = scatter.next() * static_cast<float>(n);
    float angle = scatter.between(0.0f, 6.2832f);
    const float bend = scatter.between(-0.03f, 0.03f);
    const int length = static_cast<int>(scatter.between(9.0f, 30.0f));
    const float dry =
        scatter.next() < 0.13f ? scatter.between(0.6f, 1.0f) : scatter.between(0.0f, 0.4f);
    const float tone = 0.16f + 0.52f * layer + scatter.between(-0.10f, 0.13f);
    for (int k = 0; k < length; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(length);
      const int px = static_cast<int>(std::floor(x));
      const int py = static_cast<int>(std::floor(y));
      const float value = tone * (0.72f + 0.45f * t);
      const int wide = t < 0.7f ? 1 : 0;
      for (int w = 0; w <= wide; ++w) {
        const int wx = px + (std::abs(std::cos(angle)) < 0.7f ? w : 0);
        const int wy = py + (std::abs(std::cos(angle)) < 0.7f ? 0 : w);
        brightness.at(wx, wy) = value;
        dryness.at(wx, wy) = dry;
        height.at(wx, wy) = 0.2f + 0.7f * layer;
      }
      x += std::cos(angle);
      y += std::sin(angle);
      angle += bend;
    }
  }
}

/// Clods, crumbs and a few pale stones.
class Soil {
 public:
  /// Brightness of the soil. @param height  receives its height in [0, 1]
  float value(float u, float v, float& height) const {
    float id = 0.0f;
    const float warp = 0.6f * warp_.at(u, v);
    const float clod = clods_.at(u * 26.0f + warp, v * 26.0f + warp, id);
    const float clod_shade = 0.30f * (1.0f - clod) + 0.12f * (id - 0.5f);
    float crumb_id = 0.0f;
    const float crumb = crumbs_.at(u * 90.0f, v * 90.0f, crumb_id);
    const float fine = fine_.at(u, v) - 0.5f;
    float value = 0.30f + clod_shade + 0.16f * (0.6f - crumb) + 0.45f * fine;
    height = 0.5f * (1.0f - clod) + 0.2f * (1.0f - crumb);
    float stone_id = 0.0f;
    const float stone = stones_.at(u * 17.0f, v * 17.0f, stone_id);
    if (stone_id > 0.86f && stone < 0.16f + 0.10f * (stone_id - 0.86f) / 0.14f) {
      value = 0.72f + 0.25f * (stone_id - 0.86f) / 0.14f - 1.2f * stone;
      height = 0.9f;
    }
    return value;
  }

 private:
  TiledFbm warp_{16, 3, 60}, fine_{32, 4, 67};
  TiledWorley clods_{26, 61}, crumbs_{90, 64}, stones_{17, 71};
};

}  // namespace

const imaging::Pixels& ground_texture() {
  static const imaging::Pixels texture = [] {
    constexpr int kSize = 512;
    GreyPlane grass(kSize, 0.12f);
    GreyPlane dry(kSize, 0.3f);
    GreyPlane height(kSize, 0.1f);
    paint_grass(grass, dry, height);
    const Soil ground;
    imaging::Pixels pixels(kSize, kSize);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        float soil_height = 0.0f;
        const float soil = ground.value((static_cast<float>(x) + 0.5f) / kSize,
                                        (static_cast<float>(y) + 0.5f) / kSize, soil_height);
        std::uint8_t* p = pixels.at(x, y);
        p[0] = byte(grass.at(x, y));
        p[1] = byte(dry.at(x, y));
        p[2] = byte(soil);
        p[3] = byte(0.5f * height.at(x, y) + 0.5f * soil_height);
      }
    }
    return pixels;
  }();
  return texture;
}

const imaging::Pixels& noise_texture() {
  static const imaging::Pixels texture = [] {
    constexpr int kSize = 512;
    imaging::Pixels pixels(kSize, kSize);
    // Stretches the narrow range of a sum of octaves to the full range.
    const TiledFbm first(4, 6, 11), second(8, 5, 23), clouds(3, 7, 37), blotches(16, 3, 53);
    const auto stretch = [](float v) { return (v - 0.5f) * 1.7f + 0.5f; };
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const float u = (static_cast<float>(x) + 0.5f) / kSize;
        const float v = (static_cast<float>(y) + 0.5f) / kSize;
        std::uint8_t* p = pixels.at(x, y);
        const float a = first.at(u, v);
        p[0] = byte(stretch(a));
        p[1] = byte(stretch(second.at(u, v)));
        const float bx = u + 0.11f * (a - 0.5f);
        const float by = v + 0.11f * (tiled_noise(u * 6.0f, v * 6.0f, 6, 5) - 0.5f);
        p[2] = byte(stretch(clouds.at(bx, by)));
        p[3] = byte(stretch(blotches.at(u, v)));
      }
    }
    return pixels;
  }();
  return texture;
}

namespace {

/// @param stretch  cells across for each cell along the grain
imaging::Pixels grain(const float (&dark)[3], const float (&light)[3], int across, int along,
                      std::uint32_t seed) {
  constexpr int kSize = 256;
  imaging::Pixels pixels(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / kSize;
      const float v = (static_cast<float>(y) + 0.5f) / kSize;
      const float wobble = tiled_noise(u * 4.0f, v * 4.0f, 4, seed) * 0.6f;
      // Different cell counts in x and y give fibres; both repeat over the tile.
      const float fu = u * static_cast<float>(across) + wobble;
      const float fv = v * static_cast<float>(along);
      const float coarse = tiled_noise(fu, fv, across, seed + 1);
      const float fine = tiled_noise(fu * 3.0f, fv * 2.0f, across * 3, seed + 2);
      const float blotch = tiled_fbm(u, v, 3, 3, seed + 3);
      float value = 0.5f * coarse + 0.3f * fine + 0.35f * (blotch - 0.3f);
      value = std::clamp(value, 0.0f, 1.0f);
      std::uint8_t* p = pixels.at(x, y);
      for (int c = 0; c < 3; ++c) p[c] = byte(dark[c] + (light[c] - dark[c]) * value);
      p[3] = 255;
    }
  }
  return pixels;
}

}  // namespace

const imaging::Pixels& wood_texture() {
  static const imaging::Pixels texture =
      grain({0.20f, 0.15f, 0.11f}, {0.62f, 0.53f, 0.43f}, 24, 3, 401);
  return texture;
}

const imaging::Pixels& bark_texture() {
  static const imaging::Pixels texture =
      grain({0.07f, 0.05f, 0.035f}, {0.42f, 0.32f, 0.24f}, 14, 6, 431);
  return texture;
}

}  // namespace vinerow::render
