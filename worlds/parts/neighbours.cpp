#include "worlds/parts/neighbours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "engine/math/planar.h"
#include "engine/math/polygon.h"
#include "worlds/mapping/model/row_map.h"

namespace vinerow::worlds {
namespace {

constexpr double kVerge_m = 6.0;      // between the parcel's boundary and the track around it
constexpr double kTrackSide_m = 3.5;  // from a track's middle to the field beside it
constexpr double kHeadland_m = 5.0;   // from a field's edge to the ends of its rows
constexpr double kMinSurroundings_m = 60.0;
constexpr double kMinVines_m2 = 1500.0;
constexpr double kTreesAway_m = 110.0;  // from places to be left free: what climbs there at 0.12
constexpr double kTreesIn_m = 2.5;      // from the edge of a field
constexpr double kTreesFromParcel_m = 25.0;

/// With every edge moved inwards.
Polygon shrink(const Polygon& polygon, double by_m) {
  Polygon inner = polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d d = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    if (!inner.empty()) inner = cut(inner, polygon[i] + by_m * left_of(d), d);
  }
  return inner;
}

/// An oblong with every edge moved outwards.
Polygon widen(const Polygon& oblong, double by_m) {
  Polygon outer;
  const std::size_t n = oblong.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d before = (oblong[i] - oblong[(i + n - 1) % n]).normalized();
    const Eigen::Vector2d after = (oblong[(i + 1) % n] - oblong[i]).normalized();
    outer.push_back(oblong[i] - by_m * (left_of(before) + left_of(after)));
  }
  return outer;
}

Eigen::Vector2d longest_edge(const Polygon& polygon) {
  Eigen::Vector2d longest(0, 0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (edge.norm() > longest.norm()) longest = edge;
  }
  return longest.normalized();
}

/// Least and greatest distance along a direction.
Eigen::Vector2d extent(const Polygon& polygon, const Eigen::Vector2d& d) {
  Eigen::Vector2d range(std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity());
  for (const Eigen::Vector2d& p : polygon) {
    range[0] = std::min(range[0], d.dot(p));
    range[1] = std::max(range[1], d.dot(p));
  }
  return range;
}

class Layout {
 public:
  Layout(const Polygon& parcel_W, const NeighboursOptions& options, std::uint64_t seed)
      : parcel_W_(parcel_W), options_(options), random_(seed, "", "world.neighbours") {}

  Scenery lay(const Polygon& box_W) {
    std::vector<Polygon> blocks = surround(box_W);
    while (static_cast<int>(blocks.size()) < options_.count) {
      const auto largest = std::max_element(
          blocks.begin(), blocks.end(),
          [](const Polygon& a, const Polygon& b) { return signed_area_m2(a) < signed_area_m2(b); });
      const Polygon whole = *largest;
      blocks.erase(largest);
      divide(whole, blocks);
    }
    for (const Polygon& block : blocks) add_field(block);
    return std::move(scenery_);
  }

 private:
  /// Four blocks that turn around the parcel like a pinwheel's blades, with tracks between.
  std::vector<Polygon> surround(const Polygon& box_W) {
    const Polygon core = widen(parcel_W_, kVerge_m);
    std::vector<Polygon> blocks;
    const std::size_t n = core.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d &a = core[i], &b = core[(i + 1) % n], &c = core[(i + 2) % n];
      // Right of this edge and left of where the next one's line runs on.
      const Polygon block = cut(cut(box_W, a, a - b), b, c - b);
      if (!block.empty()) blocks.push_back(block);
      const Eigen::Vector2d d = (b - a).normalized();
      const Eigen::Vector2d t = clip_line(box_W, a, d);
      scenery_.tracks.push_back({a + t[0] * d, b});
    }
    return blocks;
  }

  void divide(const Polygon& block, std::vector<Polygon>& blocks) {
    const Eigen::Vector2d edge = longest_edge(block);
    const Eigen::Vector2d along = extent(block, edge), across = extent(block, left_of(edge));
    const bool lengthwise = along[1] - along[0] > across[1] - across[0];
    const Eigen::Vector2d normal = lengthwise ? edge : left_of(edge);
    const Eigen::Vector2d range = lengthwise ? along : across;
    const double at_m = range[0] + (range[1] - range[0]) * random_.uniform(0.38, 0.62);
    Eigen::Vector2d middle(0, 0);
    for (const Eigen::Vector2d& p : block) middle += p / static_cast<double>(block.size());
    const Eigen::Vector2d p = middle + (at_m - normal.dot(middle)) * normal;
    const double lean_rad = rad_from_deg(random_.uniform(-13.0, 13.0));
    const Eigen::Vector2d d = Eigen::Rotation2Dd(lean_rad) * left_of(normal);
    blocks.push_back(cut(block, p, d));
    blocks.push_back(cut(block, p, -d));
    const Eigen::Vector2d t = clip_line(block, p, d);
    if (random_.uniform() < 0.7) {
      scenery_.tracks.push_back({p + t[0] * d, p + t[1] * d});
    } else {
      add_trees(p + t[0] * d, p + t[1] * d);
    }
  }

  void add_field(const Polygon& block) {
    SceneryField field;
    // Drawn alike for every field, so that one field's kind does not change the others.
    const double kind = random_.uniform(), lean_deg = 5.0 * random_.normal();
    const double across = random_.uniform(), tilled = random_.uniform();
    field.dryness = random_.uniform(0.1, 0.9);
    field.brightness = random_.uniform(0.74, 1.0);
    const double pitch_m = random_.uniform(2.2, 3.0), width_m = random_.uniform(0.5, 0.7);
    field.row_top_m = random_.uniform(1.8, 2.15);
    field.corners_W = shrink(block, kTrackSide_m);
    if (field.corners_W.empty()) return;
    field.planted_W = shrink(field.corners_W, kHeadland_m);
    const Eigen::Vector2d edge = longest_edge(field.corners_W);
    field.along_W =
        Eigen::Rotation2Dd(rad_from_deg(lean_deg)) * (across < 0.3 ? left_of(edge) : edge);
    const bool is_free = std::any_of(
        options_.meadow_W.begin(), options_.meadow_W.end(), [&](const Eigen::Vector2d& p) {
          return distance_m(field.corners_W, p) < options_.meadow_radius_m;
        });
    const bool has_vines =
        kind < 0.66 && !is_free && signed_area_m2(field.planted_W) > kMinVines_m2;
    if (has_vines) {
      field.pitch_m = pitch_m;
      field.row_width_m = width_m;
      field.tilled = tilled < 0.4 ? 0.0 : tilled < 0.75 ? 0.5 : 1.0;
    } else {
      field.stubble = kind > 0.84 && !is_free ? random_.uniform(0.6, 1.0) : 0.0;
      const Polygon inner = shrink(field.corners_W, kTreesIn_m);
      if (!inner.empty()) add_trees(inner[0], inner[1]);
    }
    scenery_.fields.push_back(std::move(field));
  }

  /// Trees and bushes along an edge, with gaps.
  void add_trees(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const double length_m = (to - from).norm();
    const Eigen::Vector2d d = (to - from) / length_m;
    const bool is_slender = random_.uniform() < 0.2;
    for (double s = random_.uniform(4.0, 20.0); s < length_m - 4.0;) {
      SceneryTree tree;
      tree.p_W = from + s * d + random_.uniform(-1.2, 1.2) * left_of(d);
      const double size = random_.uniform();
      tree.kind = is_slender ? 2 : size < 0.35 ? 3 : size < 0.75 ? 0 : 1;
      const bool is_gap = random_.uniform() < 0.15;
      const double step_m = random_.uniform(4.5, 9.0);
      s += step_m + (is_gap ? random_.uniform(15.0, 50.0) : 0.0);
      if (is_clear(tree.p_W)) scenery_.trees.push_back(tree);
    }
  }

  bool is_clear(const Eigen::Vector2d& p) const {
    for (const Eigen::Vector2d& free : options_.meadow_W) {
      if ((p - free).norm() < kTreesAway_m) return false;
    }
    return distance_m(parcel_W_, p) > kTreesFromParcel_m;
  }

  const Polygon& parcel_W_;
  const NeighboursOptions& options_;
  RandomStream random_;
  Scenery scenery_;
};

}  // namespace

const ParameterTable<NeighboursParams>& neighbours_table() {
  using P = NeighboursParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("count", inside(&P::options, &NeighboursOptions::count), between(4, 240),
                   "fields around the parcel, within surroundings_m")
          .numbers("meadow_m", "m", &P::meadow_m, kAnyNumber,
                   "x and y of a place that is left free of rows and trees, for launches "
                   "and landings")
          .number("meadow_radius_m", "m", inside(&P::options, &NeighboursOptions::meadow_radius_m),
                  between(0.0, 1000.0), "fields nearer to that place are meadows")
          .rule([](const P& p) -> std::string {
            if (p.meadow_m.empty() || p.meadow_m.size() == 2) return "";
            return fmt::format("meadow_m has {} numbers, needs 2: x and y", p.meadow_m.size());
          });
  return table;
}

Scenery lay_neighbours(const std::vector<Eigen::Vector2d>& parcel_W,
                       const std::vector<Eigen::Vector2d>& box_W, const NeighboursOptions& options,
                       std::uint64_t seed) {
  return Layout(parcel_W, options, seed).lay(box_W);
}

Scenery make_neighbours(const NeighboursParams& params,
                        const std::vector<Eigen::Vector2d>& parcel_W, double surroundings_m,
                        std::uint64_t seed) {
  if (surroundings_m < kMinSurroundings_m) {
    throw ConfigError(
        fmt::format("neighbours: surroundings_m = {} m leaves no room for fields, needs {} m",
                    surroundings_m, kMinSurroundings_m));
  }
  NeighboursOptions options = params.options;
  if (!params.meadow_m.empty()) {
    options.meadow_W.emplace_back(params.meadow_m[0], params.meadow_m[1]);
  }
  const Eigen::AlignedBox2d box = mapping::box_around(parcel_W);
  const Eigen::Vector2d low = box.min().array() - surroundings_m,
                        high = box.max().array() + surroundings_m;
  return lay_neighbours(parcel_W, {low, {high.x(), low.y()}, high, {low.x(), high.y()}}, options,
                        seed);
}

}  // namespace vinerow::worlds
