#pragma once
/// Deterministic noise for procedural textures. Based on integer hashes only, so the same on every
/// machine.

#include <cmath>
#include <cstdint>

namespace vinerow::render {

/// Mixes three integers to 32 well-spread bits.
inline std::uint32_t hash_cell(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ seed * 0xcb1ab31fu;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  return h ^ (h >> 15);
}

/// Uniform in [0, 1).
inline float hash01(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  return static_cast<float>(hash_cell(x, y, seed) >> 8) * (1.0f / 16777216.0f);
}

/// Sequence of uniform numbers for scattered strokes; its only state is the position.
class Scatter {
 public:
  explicit Scatter(std::uint32_t seed) : seed_(seed) {}
  float next() { return hash01(count_++, 77u, seed_); }
  float between(float low, float high) { return low + (high - low) * next(); }

 private:
  std::uint32_t seed_;
  std::uint32_t count_ = 0;
};

/// Smooth value noise in [0, 1] that repeats after `period` cells in x and y.
inline float tiled_noise(float x, float y, int period, std::uint32_t seed) {
  const float fx = std::floor(x);
  const float fy = std::floor(y);
  const auto wrap = [period](int i) {
    return static_cast<std::uint32_t>((i % period + period) % period);
  };
  const std::uint32_t x0 = wrap(static_cast<int>(fx));
  const std::uint32_t y0 = wrap(static_cast<int>(fy));
  const std::uint32_t x1 = wrap(static_cast<int>(fx) + 1);
  const std::uint32_t y1 = wrap(static_cast<int>(fy) + 1);
  float u = x - fx;
  float v = y - fy;
  u = u * u * u * (u * (u * 6.0f - 15.0f) + 10.0f);
  v = v * v * v * (v * (v * 6.0f - 15.0f) + 10.0f);
  const float a = hash01(x0, y0, seed) + u * (hash01(x1, y0, seed) - hash01(x0, y0, seed));
  const float b = hash01(x0, y1, seed) + u * (hash01(x1, y1, seed) - hash01(x0, y1, seed));
  return a + v * (b - a);
}

/// Sum of octaves in [0, 1], mean about 0.5. (x, y) in [0, 1) covers the tile.
inline float tiled_fbm(float x, float y, int cells, int octaves, std::uint32_t seed) {
  float sum = 0.0f;
  float weight = 0.5f;
  float total = 0.0f;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * tiled_noise(x * cells, y * cells, cells, seed + static_cast<std::uint32_t>(i));
    total += weight;
    weight *= 0.5f;
    cells *= 2;
  }
  return sum / total;
}

/// Distance to the nearest of one random point per cell, in cells; repeats after `period`.
/// `id` receives a uniform random number of that point.
inline float tiled_worley(float x, float y, int period, std::uint32_t seed, float& id) {
  const int cx = static_cast<int>(std::floor(x));
  const int cy = static_cast<int>(std::floor(y));
  float best = 9.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const auto wx = static_cast<std::uint32_t>(((cx + dx) % period + period) % period);
      const auto wy = static_cast<std::uint32_t>(((cy + dy) % period + period) % period);
      const float px = static_cast<float>(cx + dx) + hash01(wx, wy, seed) - x;
      const float py = static_cast<float>(cy + dy) + hash01(wx, wy, seed + 1u) - y;
      const float d = px * px + py * py;
      if (d < best) {
        best = d;
        id = hash01(wx, wy, seed + 2u);
      }
    }
  }
  return std::sqrt(best);
}

}  // namespace vinerow::render
