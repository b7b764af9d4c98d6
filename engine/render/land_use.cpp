#include "engine/render/land_use.h"

#include <algorithm>
#include <cmath>

#include "engine/api/height_field.h"
#include "engine/math/polygon.h"
#include "engine/math/polyline.h"
#include "engine/render/scenery_meshes.h"

namespace vinerow::render {

namespace {

constexpr std::size_t kMaxFields = 250;

/// Calls `paint(pixel)` for every pixel whose centre is in a convex polygon.
template <class Paint>
void fill(LandUse& land, const std::vector<Eigen::Vector2d>& polygon_W, Paint&& paint) {
  if (polygon_W.size() < 3) return;
  const double cell_x = land.size_m.x() / land.pixels.width;
  const double cell_y = land.size_m.y() / land.pixels.height;
  for (int y = 0; y < land.pixels.height; ++y) {
    const Eigen::Vector2d from = land.corner_W + Eigen::Vector2d(0.5 * cell_x, (y + 0.5) * cell_y);
    const Eigen::Vector2d range = clip_line(polygon_W, from, Eigen::Vector2d::UnitX());
    const int x0 = std::max(0, static_cast<int>(std::ceil(range[0] / cell_x)));
    const double last = std::min(range[1] / cell_x, land.pixels.width - 1.0);
    for (int x = x0; x <= last; ++x) paint(land.pixels.at(x, y));
  }
}

/// The polygon with its corners moved away from its middle.
std::vector<Eigen::Vector2d> widened(const std::vector<Eigen::Vector2d>& polygon_W) {
  constexpr double kBy_m = 3.0;
  Eigen::Vector2d middle(0, 0);
  for (const Eigen::Vector2d& p : polygon_W) middle += p / static_cast<double>(polygon_W.size());
  std::vector<Eigen::Vector2d> wider;
  for (const Eigen::Vector2d& p : polygon_W) {
    wider.push_back(p + kBy_m * (p - middle).normalized());
  }
  return wider;
}

void stamp(LandUse& land, const SceneryTrack& track) {
  const Eigen::Array2d cell(land.size_m.x() / land.pixels.width,
                            land.size_m.y() / land.pixels.height);
  const Eigen::Vector2d along = track.to_W - track.from_W;
  const double reach = LandUse::kReach_m;
  // The strip around the line, row by row.
  const Eigen::Vector2d d = along.normalized();
  const Eigen::Vector2d side = reach * Eigen::Vector2d(-d.y(), d.x());
  const Eigen::Vector2d a = track.from_W - reach * d, b = track.to_W + reach * d;
  const std::vector<Eigen::Vector2d> strip{a - side, b - side, b + side, a + side};
  for (int y = 0; y < land.pixels.height; ++y) {
    const Eigen::Vector2d from =
        land.corner_W + Eigen::Vector2d(0.5 * cell.x(), (y + 0.5) * cell.y());
    const Eigen::Vector2d range = clip_line(strip, from, Eigen::Vector2d::UnitX());
    const int x0 = std::max(0, static_cast<int>(std::ceil(range[0] / cell.x())));
    const double last = std::min(range[1] / cell.x(), land.pixels.width - 1.0);
    for (int x = x0; x <= last; ++x) {
      const Eigen::Vector2d p = from + Eigen::Vector2d(x * cell.x(), 0.0);
      const double away = distance_to_segment_m<2>(p, track.from_W, track.to_W);
      const auto value =
          static_cast<std::uint8_t>(std::min(255L, std::lround(away * 255.0 / reach)));
      std::uint8_t& stored = land.pixels.at(x, y)[1];
      stored = std::min(stored, value);
    }
  }
}

/// Raises the shade within a box to `depth(p)`, 0 to 1.
template <class Depth>
void raise_shade(LandUse& land, const Eigen::AlignedBox2d& box, Depth&& depth) {
  const Eigen::Vector2d cell(land.size_m.x() / land.pixels.width,
                             land.size_m.y() / land.pixels.height);
  const Eigen::Array2d low = (box.min() - land.corner_W).array() / cell.array();
  const Eigen::Array2d high = (box.max() - land.corner_W).array() / cell.array();
  for (int y = std::max(0, static_cast<int>(low.y()));
       y <= std::min(land.pixels.height - 1.0, high.y()); ++y) {
    for (int x = std::max(0, static_cast<int>(low.x()));
         x <= std::min(land.pixels.width - 1.0, high.x()); ++x) {
      const Eigen::Vector2d p =
          land.corner_W + Eigen::Vector2d((x + 0.5) * cell.x(), (y + 0.5) * cell.y());
      std::uint8_t& stored = land.pixels.at(x, y)[3];
      const double shade = std::clamp(static_cast<double>(depth(p)), 0.0, 1.0);
      stored = std::max(stored, static_cast<std::uint8_t>(std::lround(255.0 * shade)));
    }
  }
}

/// Draws the shadow of a tree on level ground: of its crown, an ellipsoid, and of its trunk.
void shade(LandUse& land, const SceneryTree& tree, const Eigen::Vector3d& sun_W) {
  if (tree.kind < 0 || tree.kind >= kSceneryTreeKinds) return;
  const SceneryTreeSize& size = kSceneryTrees[tree.kind];
  const Eigen::Vector2d away = -sun_W.head<2>() / std::max(sun_W.z(), 0.1);
  const double base = scenery_crown_base_m(size);
  const double r = 0.5 * size.crown_width_m, h = 0.5 * (size.height_m - base);
  const Eigen::Vector2d offset = (base + h) * away, middle = tree.p_W + offset;
  const double reach = std::hypot(r, h * away.norm());
  const Eigen::Vector2d along =
      away.norm() > 1e-6 ? Eigen::Vector2d(away.normalized()) : Eigen::Vector2d::UnitX();
  const Eigen::Vector2d around = Eigen::Vector2d::Constant(reach);
  raise_shade(land, {Eigen::Vector2d(middle - around), Eigen::Vector2d(middle + around)},
              [&](const Eigen::Vector2d& p) {
                const Eigen::Vector2d d = p - middle;
                const double u = along.dot(d) / reach;
                const double v = (along.x() * d.y() - along.y() * d.x()) / r;
                return 2.5 * (1.0 - std::hypot(u, v));
              });
  constexpr double kHalfTrunk_m = 0.8;  // with its soft edge; cells are not finer
  const Eigen::Vector2d border = Eigen::Vector2d::Constant(kHalfTrunk_m);
  raise_shade(land,
              {Eigen::Vector2d(tree.p_W.cwiseMin(middle) - border),
               Eigen::Vector2d(tree.p_W.cwiseMax(middle) + border)},
              [&](const Eigen::Vector2d& p) {
                const double t = std::clamp(
                    (p - tree.p_W).dot(offset) / std::max(offset.squaredNorm(), 1e-12), 0.0, 1.0);
                return 2.0 * (kHalfTrunk_m - (p - tree.p_W - t * offset).norm());
              });
}

}  // namespace

LandUse make_land_use(const Scenery& scenery, const HeightField& terrain,
                      const Eigen::Vector3d& sun_W) {
  LandUse land;
  land.corner_W = terrain.corner_W;
  land.size_m = {terrain.width_m(), terrain.depth_m()};
  constexpr double kWantedCell_m = 0.5;
  land.pixels = imaging::Pixels(imaging::texture_side(land.size_m.x() / kWantedCell_m),
                                imaging::texture_side(land.size_m.y() / kWantedCell_m));
  for (std::size_t i = 1; i < land.pixels.rgba.size(); i += 4) land.pixels.rgba[i] = 255;
  const std::size_t count = std::min(scenery.fields.size(), kMaxFields);
  for (std::size_t i = 0; i < count; ++i) {
    const SceneryField& field = scenery.fields[i];
    // The number extends slightly beyond the field, so that texels on both sides of its edge have
    // the same number.
    fill(land, widened(field.corners_W),
         [&](std::uint8_t* p) { p[0] = static_cast<std::uint8_t>(i + 1); });
    fill(land, field.corners_W, [](std::uint8_t* p) { p[2] = 128; });
    fill(land, field.planted_W, [](std::uint8_t* p) { p[2] = 255; });
    const Eigen::Vector2d normal(-field.along_W.y(), field.along_W.x());
    const double offset_m = normal.dot(field.corners_W.front());
    for (const double v : {normal.x(), normal.y(), offset_m, field.pitch_m, field.dryness,
                           field.tilled, field.stubble, field.brightness, 0.5 * field.row_width_m,
                           field.row_base_m, field.row_top_m, 0.0}) {
      land.table.push_back(static_cast<float>(v));
    }
  }
  for (const SceneryTrack& track : scenery.tracks) stamp(land, track);
  for (const SceneryTree& tree : scenery.trees) shade(land, tree, sun_W);
  return land;
}

}  // namespace vinerow::render
