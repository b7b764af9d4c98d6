#include "engine/render/grass_tufts.h"

#include <algorithm>
#include <cmath>

#include "engine/api/height_field.h"
#include "engine/math/angles.h"
#include "engine/render/builtin_textures.h"
#include "engine/render/noise.h"

namespace vinerow::render {

namespace {

struct Tuft {
  double away_m;  ///< from the camera, level
  Eigen::Vector3d root_W;
  Eigen::Vector3d normal_W;
  double width_m;
  double height_m;
  double yaw_rad;
  float brightness;
  float dryness;
  int layer;
};

void add_tuft(const Tuft& tuft, std::vector<GpuVertex>& vertices,
              std::vector<std::uint32_t>& indices) {
  for (int quad = 0; quad < 2; ++quad) {
    const double yaw = tuft.yaw_rad + 0.5 * kPi * quad;
    const Eigen::Vector3d half =
        0.5 * tuft.width_m * Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0);
    const Eigen::Vector3d up(0.0, 0.0, tuft.height_m);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (int corner = 0; corner < 4; ++corner) {
      const bool right = corner == 1 || corner == 2;
      const bool top = corner >= 2;
      const Eigen::Vector3d p = tuft.root_W + (right ? half : -half) + (top ? up : -0.02 * up);
      GpuVertex vertex{};
      for (int c = 0; c < 3; ++c) {
        vertex.position[c] = static_cast<float>(p[c]);
        vertex.normal[c] = static_cast<std::int8_t>(std::lround(tuft.normal_W[c] * 127.0));
      }
      vertex.uv[0] = right ? 1.0f : 0.0f;
      vertex.uv[1] = top ? 1.0f : 0.0f;
      vertex.colour[0] = static_cast<std::uint8_t>(tuft.brightness * 255.0f);
      vertex.colour[1] = static_cast<std::uint8_t>(tuft.dryness * 255.0f);
      vertex.colour[3] = static_cast<std::uint8_t>(tuft.layer);
      vertices.push_back(vertex);
    }
    indices.insert(indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
  }
}

double distance_m(const SceneryTrack& track, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = track.to_W - track.from_W;
  const double t =
      std::clamp((p - track.from_W).dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
  return (p - track.from_W - t * along).norm();
}

/// Tracks that pass within a range of a place.
std::vector<SceneryTrack> tracks_near(std::span<const SceneryTrack> tracks,
                                      const Eigen::Vector2d& p, double range_m) {
  std::vector<SceneryTrack> near;
  for (const SceneryTrack& track : tracks) {
    if (distance_m(track, p) < range_m) near.push_back(track);
  }
  return near;
}

}  // namespace

void make_grass_tufts(const GrassGround& ground, const Camera& camera, const Frustum& frustum,
                      double seen_scale, std::vector<GpuVertex>& vertices,
                      std::vector<std::uint32_t>& indices) {
  const HeightField& field = ground.field;
  const imaging::GroundMask& mask = ground.mask;
  vertices.clear();
  indices.clear();
  constexpr double kCell_m = 0.21;
  const double range = std::min(24.0, 17.0 / seen_scale);
  const Eigen::Vector3d& eye = camera.X_WC.p;
  const double above = eye.z() - field.height_m(eye.x(), eye.y());
  if (camera.orthographic || above > range) return;

  constexpr double kHalfTrack_m = 1.6;
  const std::vector<SceneryTrack> tracks =
      tracks_near(ground.tracks, eye.head<2>(), range + kHalfTrack_m);
  std::vector<Tuft> tufts;
  const int i0 = static_cast<int>(std::floor((eye.x() - range) / kCell_m));
  const int i1 = static_cast<int>(std::floor((eye.x() + range) / kCell_m));
  const int j0 = static_cast<int>(std::floor((eye.y() - range) / kCell_m));
  const int j1 = static_cast<int>(std::floor((eye.y() + range) / kCell_m));
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const auto cx = static_cast<std::uint32_t>(i);
      const auto cy = static_cast<std::uint32_t>(j);
      const double x = (i + hash01(cx, cy, 1)) * kCell_m;
      const double y = (j + hash01(cx, cy, 2)) * kCell_m;
      if (!field.contains(x, y)) continue;
      const double away = std::hypot(x - eye.x(), y - eye.y());
      // With distance a growing share of tufts is omitted, 88 % at the end of the range; the others
      // get wider.
      const double keep = std::clamp(1.35 - away / range, 0.0, 1.0);
      const double fate = hash01(cx, cy, 3);
      if (away > range || fate > keep * keep) continue;
      const double z = field.height_m(x, y);
      const Eigen::Vector3d root(x, y, z);
      if (!frustum.may_see(
              {root - Eigen::Vector3d(0.2, 0.2, 0.0), root + Eigen::Vector3d(0.2, 0.2, 0.3)})) {
        continue;
      }
      if (hash01(cx, cy, 11) < ground.bare) continue;
      if (std::any_of(tracks.begin(), tracks.end(), [&](const SceneryTrack& track) {
            return distance_m(track, {x, y}) < kHalfTrack_m;
          })) {
        continue;
      }
      const double row = mask.row_distance_m(x, y);
      const double alley = mask.alley_distance_m(x, y);
      const float chance = hash01(cx, cy, 4);
      if (row < 0.36 && chance > 0.22f) continue;                     // bare strip
      if (std::abs(alley - 0.60) < 0.16 && chance > 0.30f) continue;  // wheel tracks
      const double patch =
          tiled_noise(static_cast<float>(x * 0.45), static_cast<float>(y * 0.45), 4096, 8);
      const double fringe = std::clamp(1.0 - std::abs(row - 0.55) / 0.30, 0.0, 1.0);
      const double fade = std::clamp((range - away) / (0.3 * range), 0.0, 1.0);
      Tuft tuft{};
      tuft.away_m = away;
      tuft.root_W = root;
      tuft.normal_W = field.normal_W(x, y);
      const double size = (0.6 + 0.7 * hash01(cx, cy, 5)) * (0.35 + 0.65 * fade);
      tuft.height_m = size * (0.050 + 0.075 * patch * patch + 0.10 * fringe);
      tuft.width_m = size * (0.16 + 0.07 * fringe) * (1.0 + 0.8 * (1.0 - keep));
      tuft.yaw_rad = 2.0 * kPi * hash01(cx, cy, 6);
      tuft.brightness = 0.72f + 0.28f * hash01(cx, cy, 7);
      tuft.dryness = hash01(cx, cy, 9);
      tuft.layer = kGrassLayer + static_cast<int>(hash_cell(cx, cy, 10) % kGrassLayers);
      tufts.push_back(tuft);
    }
  }
  // Near ones first: what they hide need not be shaded.
  std::stable_sort(tufts.begin(), tufts.end(),
                   [](const Tuft& a, const Tuft& b) { return a.away_m < b.away_m; });
  for (const Tuft& tuft : tufts) add_tuft(tuft, vertices, indices);
}

}  // namespace vinerow::render
