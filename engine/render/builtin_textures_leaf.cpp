#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "engine/render/builtin_textures.h"
#include "engine/render/noise.h"

namespace vinerow::render {

namespace {

constexpr int kSize = 256;
constexpr float kPiF = 3.14159265f;

struct Leaf {
  float x, y;        ///< where the stalk meets the blade, 0..1
  float radius;      ///< length of the longest lobe, 0..1
  float angle;       ///< direction of the middle lobe
  float brightness;  ///< 0..1, 0.5 = mean
  float tilt_x, tilt_y;
  std::uint32_t seed;
};

/// Outline of a grapevine leaf: five lobes, an open sinus at the stalk, toothed edge.
/// @param t  angle from the middle lobe, [-pi, pi]. @returns radius, 1 = tip of the middle lobe
float vine_leaf_radius(float t) {
  const float a = std::abs(t);
  // Lobes at 0, 62 and 118 deg, wide enough to overlap into shallow bays.
  const auto lobe = [a](float centre, float width, float height) {
    const float d = (a - centre) / width;
    return height * std::exp(-d * d);
  };
  float r =
      std::max({lobe(0.0f, 0.48f, 1.0f), lobe(1.05f, 0.46f, 0.92f), lobe(2.06f, 0.50f, 0.80f)});
  r = std::max(r, 0.70f);
  // Sinus towards the stalk.
  const float sinus = std::clamp((kPiF - a - 0.10f) / 0.45f, 0.0f, 1.0f);
  r *= 0.25f + 0.75f * sinus;
  const float teeth = std::abs(std::fmod(a * 5.1f + 0.2f, 1.0f) - 0.5f);
  return r * (0.93f + 0.14f * teeth);
}

/// Outline of a fruit tree's leaf: a plain oval with a tip; the stalk is at its lower end.
float tree_leaf_inside(float along, float across) {
  if (along < 0.0f || along > 1.0f) return -1.0f;
  const float half_width = 0.27f * std::sin(kPiF * std::pow(along, 0.85f));
  return half_width - std::abs(across);
}

void set_pixel(std::uint8_t* p, float brightness, float tilt_x, float tilt_y, float alpha) {
  const auto byte = [](float v) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255.0f));
  };
  const float old = static_cast<float>(p[3]) / 255.0f;
  const auto mix = [&](std::uint8_t below, float v) {
    return old <= 0.0f ? byte(v)
                       : byte(static_cast<float>(below) / 255.0f * (1.0f - alpha) + v * alpha);
  };
  p[0] = mix(p[0], brightness);
  p[1] = mix(p[1], tilt_x);
  p[2] = mix(p[2], tilt_y);
  p[3] = byte(old + alpha * (1.0f - old));
}

/// Paints one leaf over the present content.
void paint_leaf(imaging::Pixels& card, const Leaf& leaf, bool vine) {
  const float reach = leaf.radius * 1.12f;
  const auto low = [&](float c) { return std::max(0, static_cast<int>((c - reach) * kSize)); };
  const auto high = [&](float c) {
    return std::min(kSize - 1, static_cast<int>((c + reach) * kSize) + 1);
  };
  const float c = std::cos(leaf.angle);
  const float s = std::sin(leaf.angle);
  const float pixel = 1.0f / (kSize * leaf.radius);
  for (int y = low(leaf.y); y <= high(leaf.y); ++y) {
    for (int x = low(leaf.x); x <= high(leaf.x); ++x) {
      const float dx = (static_cast<float>(x) + 0.5f) / kSize - leaf.x;
      const float dy = (static_cast<float>(y) + 0.5f) / kSize - leaf.y;
      // Leaf coordinates: u along the middle vein, v across, 1 = leaf radius.
      const float u = (dx * c + dy * s) / leaf.radius;
      const float v = (-dx * s + dy * c) / leaf.radius;
      const float r = std::hypot(u, v);
      const auto alpha_of = [&](float in) { return std::clamp(in / pixel + 0.5f, 0.0f, 1.0f); };
      // No lobe reaches beyond 1: this skips the costly outline outside.
      if (vine && alpha_of((1.0f - r) * 0.8f) <= 0.0f) continue;
      const float t = vine ? std::atan2(v, u) : 0.0f;
      const float inside = vine ? (vine_leaf_radius(t) - r) * 0.8f : tree_leaf_inside(u, v);
      const float alpha = alpha_of(inside);
      if (alpha <= 0.0f) continue;
      float vein = vine ? 9.0f : std::abs(v);
      if (vine) {
        for (const float centre : {0.0f, 1.05f, -1.05f, 2.0f, -2.0f}) {
          const float d = t - centre;
          if (std::cos(d) > 0.0f) vein = std::min(vein, std::abs(std::sin(d)) * r);
        }
      }
      const float mottle = tiled_noise(u * 7.0f + 50.0f, v * 7.0f + 50.0f, 97, leaf.seed) - 0.5f;
      float brightness = leaf.brightness + 0.10f * mottle;
      brightness += vein < 0.022f ? 0.12f : 0.0f;
      brightness -= 0.10f * std::exp(-inside * 22.0f);  // the edge turns down
      // The blade is slightly folded along the middle vein and bulges between the veins.
      const float fold = v > 0.0f ? 0.07f : -0.07f;
      const float tilt_x = leaf.tilt_x - s * fold + 0.10f * mottle;
      const float tilt_y = leaf.tilt_y + c * fold + 0.10f * (r - 0.4f);
      set_pixel(card.at(x, y), brightness, 0.5f + tilt_x, 0.5f + tilt_y, alpha);
    }
  }
}

/// Paints a thin green shoot or stalk.
void paint_shoot(imaging::Pixels& card, float x0, float y0, float x1, float y1, float width) {
  const int steps = static_cast<int>(std::hypot(x1 - x0, y1 - y0) * kSize * 1.5f) + 1;
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const float cx = (x0 + (x1 - x0) * t) * kSize;
    const float cy = (y0 + (y1 - y0) * t) * kSize;
    const int reach = std::max(1, static_cast<int>(width * kSize));
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int x = static_cast<int>(cx) + dx;
        const int y = static_cast<int>(cy) + dy;
        if (x < 0 || y < 0 || x >= kSize || y >= kSize || std::hypot(dx, dy) > reach) continue;
        set_pixel(card.at(x, y), 0.42f, 0.5f, 0.5f, 1.0f);
      }
    }
  }
}

/// Paints leaves scattered over the card; the lowest are painted first and are darkest.
imaging::Pixels leaf_card(bool vine, int count, float radius, std::uint32_t seed) {
  imaging::Pixels card(kSize, kSize);
  Scatter scatter(seed);
  if (count == 1) {
    paint_shoot(card, 0.5f, 0.02f, 0.5f, 0.3f, 0.008f);
    const float y = vine ? 0.36f : 0.08f;
    paint_leaf(
        card, {0.5f, y, radius, 0.5f * kPiF + scatter.between(-0.1f, 0.1f), 0.5f, 0.0f, 0.0f, seed},
        vine);
    return card;
  }
  for (int i = 0; i < 3; ++i) {  // shoots that the leaves hang on
    const float a = scatter.between(0.0f, 2.0f * kPiF);
    paint_shoot(card, 0.5f, 0.5f, 0.5f + 0.36f * std::cos(a), 0.5f + 0.36f * std::sin(a), 0.006f);
  }
  for (int i = 0; i < count; ++i) {
    // Sunflower spiral: even coverage without a grid; jitter makes the outline ragged.
    const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    const float a = static_cast<float>((i * 7) % count) * 2.39996f + scatter.between(-0.4f, 0.4f);
    const float spread = 0.5f - 0.95f * radius;
    const float rho =
        spread * std::sqrt(static_cast<float>((i * 7) % count + 1) / static_cast<float>(count));
    const float size = radius * scatter.between(0.68f, 1.0f);
    Leaf leaf{};
    leaf.x = 0.5f + rho * std::cos(a) + scatter.between(-0.03f, 0.03f);
    leaf.y = 0.5f + rho * std::sin(a) + scatter.between(-0.03f, 0.03f);
    leaf.radius = size;
    // Blades hang outwards and down.
    leaf.angle = a + scatter.between(-0.9f, 0.9f);
    leaf.brightness = 0.30f + 0.26f * share + scatter.between(-0.07f, 0.07f);
    leaf.tilt_x = scatter.between(-0.30f, 0.30f);
    leaf.tilt_y = scatter.between(-0.30f, 0.30f);
    leaf.seed = seed + static_cast<std::uint32_t>(i);
    paint_leaf(card, leaf, vine);
  }
  return card;
}

/// Paints grass blades that grow from the lower edge.
imaging::Pixels grass_card(std::uint32_t seed) {
  imaging::Pixels card(kSize, kSize);
  Scatter scatter(seed);
  constexpr int kBlades = 34;
  for (int i = 0; i < kBlades; ++i) {
    const float root = 0.5f + scatter.between(-0.30f, 0.30f);
    const float lean = (root - 0.5f) * 0.7f + scatter.between(-0.22f, 0.22f);
    const float length = scatter.between(0.35f, 0.97f) * (1.0f - 0.7f * std::abs(root - 0.5f));
    const float width = scatter.between(0.010f, 0.019f);
    const float brightness =
        0.40f + 0.20f * static_cast<float>(i) / kBlades + scatter.between(-0.08f, 0.08f);
    const float dryness = scatter.next() < 0.16f ? 1.0f : scatter.between(0.0f, 0.35f);
    const int steps = kSize;
    for (int k = 0; k <= steps; ++k) {
      const float t = static_cast<float>(k) / steps;
      const float cx = root + lean * t * t;
      const float cy = length * t * (1.0f - 0.25f * std::abs(lean) * t);
      const float half = width * (1.0f - t * t) + 0.0015f;
      const int y = static_cast<int>(cy * kSize);
      for (int x = static_cast<int>((cx - half) * kSize);
           x <= static_cast<int>((cx + half) * kSize); ++x) {
        if (x < 0 || x >= kSize || y < 0 || y >= kSize) continue;
        // G carries dryness here: grass is lit like the ground, without tilt.
        set_pixel(card.at(x, y), brightness * (0.55f + 0.6f * t), 0.2f + 0.6f * dryness, 0.5f,
                  1.0f);
      }
    }
  }
  return card;
}

imaging::Pixels make_card(int layer) {
  if (layer >= kGrassLayer) {
    return grass_card(5000u + static_cast<std::uint32_t>(layer - kGrassLayer) * 50u);
  }
  const bool vine = layer < kLeafLayersPerKind;
  const int of_kind = layer % kLeafLayersPerKind;
  const std::uint32_t seed = vine ? 100u : 900u;
  const auto number = [&](int first) { return static_cast<std::uint32_t>(of_kind - first); };
  if (of_kind < kLeafSpray) {
    return leaf_card(vine, 1, vine ? 0.52f : 0.86f, seed + number(kLeafSingle));
  }
  if (of_kind < kLeafClump) {
    return leaf_card(vine, vine ? 13 : 26, vine ? 0.185f : 0.24f,
                     seed + 10 + number(kLeafSpray) * 40);
  }
  return leaf_card(vine, vine ? 62 : 110, vine ? 0.088f : 0.115f,
                   seed + 200 + number(kLeafClump) * 80);
}

}  // namespace

const imaging::Pixels& card_texture(int layer) {
  static std::array<std::once_flag, kCardLayers> once;
  static std::array<imaging::Pixels, kCardLayers> cards;
  const auto i = static_cast<std::size_t>(layer);
  std::call_once(once.at(i), [&] { cards[i] = make_card(layer); });
  return cards[i];
}

}  // namespace vinerow::render
