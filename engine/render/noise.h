#pragma once
/// Deterministic noise for procedural textures. Based on integer hashes only, so the same on every
/// machine.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// Smooth value noise in [0, 1] on a lattice with wrap(i) and at(x, y).
template <class L>
float noise_on(const L& lattice, float x, float y) {
  const float fx = std::floor(x);
  const float fy = std::floor(y);
  const int x0 = lattice.wrap(static_cast<int>(fx)), x1 = lattice.wrap(static_cast<int>(fx) + 1);
  const int y0 = lattice.wrap(static_cast<int>(fy)), y1 = lattice.wrap(static_cast<int>(fy) + 1);
  float u = x - fx;
  float v = y - fy;
  u = u * u * u * (u * (u * 6.0f - 15.0f) + 10.0f);
  v = v * v * v * (v * (v * 6.0f - 15.0f) + 10.0f);
  const float a = lattice.at(x0, y0) + u * (lattice.at(x1, y0) - lattice.at(x0, y0));
  const float b = lattice.at(x0, y1) + u * (lattice.at(x1, y1) - lattice.at(x0, y1));
  return a + v * (b - a);
}

/// Smooth value noise in [0, 1] that repeats after `period` cells in x and y.
inline float tiled_noise(float x, float y, int period, std::uint32_t seed) {
  struct {
    int period;
    std::uint32_t seed;
    int wrap(int i) const { return (i % period + period) % period; }
    float at(int x, int y) const {
      return hash01(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed);
    }
  } const lattice{period, seed};
  return noise_on(lattice, x, y);
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

/// Random numbers of a lattice that repeats: what hash01() gives, computed once.
class Lattice {
 public:
  Lattice(int period, std::uint32_t seed) : period_(period) {
    for (int y = 0; y < period; ++y) {
      for (int x = 0; x < period; ++x) {
        value_.push_back(
            hash01(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed));
      }
    }
  }
  int wrap(int i) const { return (i % period_ + period_) % period_; }
  /// @pre both wrapped
  float at(int x, int y) const { return value_[static_cast<std::size_t>(y * period_ + x)]; }
  int period() const { return period_; }

 private:
  int period_;
  std::vector<float> value_;
};

/// tiled_fbm() at many places.
class TiledFbm {
 public:
  TiledFbm(int cells, int octaves, std::uint32_t seed) {
    for (int i = 0; i < octaves; ++i) {
      octaves_.emplace_back(cells, seed + static_cast<std::uint32_t>(i));
      cells *= 2;
    }
  }
  float at(float x, float y) const {
    float sum = 0.0f, weight = 0.5f, total = 0.0f;
    for (const Lattice& lattice : octaves_) {
      const auto cells = static_cast<float>(lattice.period());
      sum += weight * noise_on(lattice, x * cells, y * cells);
      total += weight;
      weight *= 0.5f;
    }
    return sum / total;
  }

 private:
  std::vector<Lattice> octaves_;
};

/// Distance to the nearest of one random point per cell, in cells; repeats after `period`.
class TiledWorley {
 public:
  TiledWorley(int period, std::uint32_t seed)
      : x_(period, seed), y_(period, seed + 1u), id_(period, seed + 2u) {}
  /// @param id  receives a uniform random number of that point
  float at(float x, float y, float& id) const {
    const int cx = static_cast<int>(std::floor(x)), cy = static_cast<int>(std::floor(y));
    float best = 9.0f;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int wx = x_.wrap(cx + dx), wy = x_.wrap(cy + dy);
        const float px = static_cast<float>(cx + dx) + x_.at(wx, wy) - x;
        const float py = static_cast<float>(cy + dy) + y_.at(wx, wy) - y;
        const float d = px * px + py * py;
        if (d < best) {
          best = d;
          id = id_.at(wx, wy);
        }
      }
    }
    return std::sqrt(best);
  }

 private:
  Lattice x_, y_, id_;
};

}  // namespace vinerow::render
