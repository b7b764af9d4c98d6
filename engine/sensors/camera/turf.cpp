#include "engine/sensors/camera/turf.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/api/map.h"
#include "engine/api/world_model.h"

namespace vinerow::sensors {
namespace {

using Eigen::Vector3f;

/// Uniform in [0, 1) by cell (Wang's mixing steps).
float hash_of(std::int64_t i, std::int64_t j, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(i) * 0x8da6b343u ^
                    static_cast<std::uint32_t>(j) * 0xd8163841u ^ seed * 0xcb1ab31fu;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  h ^= h >> 15;
  return static_cast<float>(h >> 8) * 0x1p-24f;
}

/// Without a call, which std::floor() is on processors of the baseline.
std::int64_t floor_of(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  return whole - (static_cast<double>(whole) > x ? 1 : 0);
}

/// Smooth noise over cells of a given size, mean 0.5; fades to the mean where a pixel is larger
/// than half a cell.
float noise(double x, double y, double cell_m, double footprint_m, std::uint32_t seed) {
  const auto shown = static_cast<float>(std::clamp(2.0 - 2.0 * footprint_m / cell_m, 0.0, 1.0));
  if (shown == 0.0f) return 0.5f;
  const double u = x / cell_m, v = y / cell_m;
  const std::int64_t i = floor_of(u), j = floor_of(v);
  const auto fu = static_cast<double>(i), fv = static_cast<double>(j);
  const auto smooth = [](double t) { return static_cast<float>(t * t * (3.0 - 2.0 * t)); };
  const float su = smooth(u - fu), sv = smooth(v - fv);
  const float low = hash_of(i, j, seed) * (1.0f - su) + hash_of(i + 1, j, seed) * su;
  const float high = hash_of(i, j + 1, seed) * (1.0f - su) + hash_of(i + 1, j + 1, seed) * su;
  const float value = low * (1.0f - sv) + high * sv;
  return 0.5f + shown * (value - 0.5f);
}

float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

Vector3f mix(const Vector3f& a, const Vector3f& b, float share) {
  return a + share * (b - a);
}

}  // namespace

Turf::Turf(const WorldModel& world)
    : mask_(imaging::make_ground_mask(*world.rows)), look_(imaging::look_of(world.soil)) {}

Vector3f Turf::albedo(double x, double y, double footprint_m) const {
  // Blades and clods, tufts, patches, and slow changes over the field.
  const float blade = noise(x, y, 0.013, footprint_m, 1), clod = noise(x, y, 0.045, footprint_m, 2);
  const float tuft = noise(x, y, 0.21, footprint_m, 3), patch = noise(x, y, 1.3, footprint_m, 4);
  const float field = noise(x, y, 9.0, footprint_m, 5), dry = noise(x, y, 5.7, footprint_m, 6);

  // Grass: lush or dry.
  const float fine = std::clamp(0.45f * blade + 0.35f * clod + 0.35f * tuft, 0.0f, 1.0f);
  const float lush = smoothstep(0.25f, 0.75f, 0.6f * field + 0.4f * patch);
  const Vector3f deep =
      mix(Vector3f(0.050f, 0.062f, 0.022f), Vector3f(0.030f, 0.054f, 0.017f), lush);
  const Vector3f light =
      mix(Vector3f(0.225f, 0.232f, 0.095f), Vector3f(0.135f, 0.192f, 0.062f), lush);
  const Vector3f straw(0.34f, 0.285f, 0.160f);
  const float dryness = std::clamp(0.75f * (0.5f * tuft + look_.grass_dryness) +
                                       0.75f * (0.65f * dry + 0.35f * patch - 0.55f) + 0.1f,
                                   0.0f, 0.8f);
  Vector3f grass = mix(mix(deep, light, fine), straw * (0.25f + 0.95f * fine), dryness);
  grass *= look_.grass_brightness;

  const Vector3f soil =
      mix(Vector3f(0.098f, 0.066f, 0.043f), Vector3f(0.335f, 0.255f, 0.176f),
          std::clamp(0.5f * clod + 0.3f * blade + 0.35f * (patch - 0.25f), 0.0f, 1.0f))
          .cwiseProduct(look_.soil_tint);

  // Bare strip under the vines with ragged edges and weeds; wheel tracks next to an alley's middle.
  const auto to_row = static_cast<float>(mask_.row_distance_m(x, y));
  const auto to_middle = static_cast<float>(mask_.alley_distance_m(x, y));
  const float ragged = 0.30f * (tuft - 0.5f) + 0.20f * (patch - 0.5f);
  float strip = 1.0f - smoothstep(0.24f, 0.44f, to_row + ragged);
  strip *= 1.0f - 0.6f * smoothstep(0.50f, 0.75f, 0.5f * patch + 0.5f * tuft);
  float track = 1.0f - smoothstep(0.05f, 0.24f, std::abs(to_middle - 0.60f) + 0.7f * ragged);
  track *= 0.6f * smoothstep(0.25f, 0.75f, patch + 0.4f * (tuft - 0.5f));
  const float cover = 0.5f * patch + 0.3f * tuft + 0.2f * field;
  const float scar = smoothstep(1.05f - 1.2f * look_.bare, 1.45f - 1.35f * look_.bare, cover);
  const float bare = std::clamp(std::max({strip, track, scar}), 0.0f, 1.0f);
  return mix(grass, soil, bare);
}

}  // namespace vinerow::sensors
