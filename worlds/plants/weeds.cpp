#include "worlds/plants/weeds.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/parts/primitives.h"
#include "worlds/plants/leaf_mesh.h"
#include "worlds/plants/plant_instance.h"

namespace vinerow::worlds {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Linear RGB. Chosen.
const Vector3f kGrassBlade(0.10f, 0.17f, 0.05f), kRosetteLeaf(0.05f, 0.13f, 0.03f);
const Vector3f kHerbLeaf(0.09f, 0.16f, 0.07f), kHerbStem(0.13f, 0.19f, 0.07f);

/// A level keeps every first, second or sixth leaf, with the area of those that it stands for.
constexpr int kFewerLeaves[] = {1, 2, 6};

/// Unit vector at a bearing and an angle above the horizon.
Vector3d direction_at(double bearing_rad, double elevation_rad) {
  const double level = std::cos(elevation_rad);
  return {level * std::cos(bearing_rad), level * std::sin(bearing_rad), std::sin(elevation_rad)};
}

Vector3f shaded(const Vector3f& colour, RandomStream& random) {
  return static_cast<float>(random.uniform(0.75, 1.25)) * colour;
}

/// A plant that grows into a mesh. Every level draws the same numbers, also for leaves that it
/// leaves out: the others keep their places. Leaves go round by the golden angle. Shapes are
/// chosen.
class WeedGrower {
 public:
  WeedGrower(TriangleMesh& mesh, const Weed& weed, int level)
      : mesh_(mesh),
        root_W_(weed.root_W),
        height_m_(weed.height_m),
        level_(level),
        random_(weed.seed, "", "weed") {}

  void grow() {
    const double kind = random_.uniform();
    if (kind < 0.4) {
      grow_grass();
    } else if (kind < 0.7) {
      grow_rosette();
    } else {
      grow_herb();
    }
  }

 private:
  int fewer() const { return kFewerLeaves[level_]; }

  void grow_grass() {
    constexpr int kBlades = 18;
    const Vector3f colour = shaded(kGrassBlade, random_);
    for (int i = 0; i < kBlades; ++i) {
      const double bearing = kGoldenAngle_rad * i + random_.uniform(-0.4, 0.4);
      const double elevation = rad_from_deg(random_.uniform(45.0, 88.0));
      const double length_m = height_m_ * random_.uniform(0.8, 1.2);
      const double width_m = 0.004 * random_.uniform(0.7, 1.2);
      if (i % fewer() == 0)
        add_grass_blade(bearing, elevation, length_m, fewer() * width_m, colour);
    }
  }

  /// Two pieces: straight, then bent over to the tip.
  void add_grass_blade(double bearing_rad, double elevation_rad, double length_m, double width_m,
                       const Vector3f& colour) {
    constexpr double kBend_rad = rad_from_deg(50.0);
    const Vector3d lower = direction_at(bearing_rad, elevation_rad);
    const Vector3d upper = direction_at(bearing_rad, elevation_rad - kBend_rad);
    const Vector3d side(-std::sin(bearing_rad), std::cos(bearing_rad), 0.0);
    const Vector3d foot = root_W_ + 0.008 * direction_at(bearing_rad, 0.0);
    const Vector3d bend = foot + 0.6 * length_m * lower, tip = bend + 0.4 * length_m * upper;
    const double half_m = 0.5 * width_m;
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto add = [&](const Vector3d& p, const Vector3d& along) {
      mesh_.vertices.push_back(p.cast<float>());
      mesh_.normals.push_back(along.cross(side).cast<float>());
      mesh_.colours.push_back(colour);
    };
    add(foot - half_m * side, lower);
    add(foot + half_m * side, lower);
    add(bend + half_m * side, lower);
    add(bend - half_m * side, lower);
    add(tip, upper);
    mesh_.triangles.push_back({first, first + 1, first + 2});
    mesh_.triangles.push_back({first, first + 2, first + 3});
    mesh_.triangles.push_back({first + 3, first + 2, first + 4});
  }

  /// The upper face looks up. @param widening  of a blade that stands for several: the part of
  /// their area that makes it wider and not longer
  void add_leaf(LeafKind kind, const Vector3d& junction_W, const Vector3d& along, double length_m,
                const Vector3f& colour, double widening = 1.0) {
    LeafOrgan leaf;
    leaf.node = leaf.junction = junction_W;
    leaf.along = along;
    leaf.normal = (Vector3d::UnitZ() - along.z() * along).normalized();
    leaf.colour = colour;
    const double unit_m = leaf_length_m(kind, 1.0);
    leaf.area_m2 = length_m * length_m / (unit_m * unit_m);
    append_blade(mesh_, kind, leaf, fewer() * leaf.area_m2, std::max(level_, 1), widening);
  }

  void grow_rosette() {
    constexpr double kLongestLeaf_m = 0.4;  // as of large docks and dandelions
    const Vector3f colour = shaded(kRosetteLeaf, random_);
    const int leaves = 7 + static_cast<int>(random_.uniform() * 8.0);
    for (int i = 0; i < leaves; ++i) {
      const double bearing = kGoldenAngle_rad * i + random_.uniform(-0.2, 0.2);
      const Vector3d along = direction_at(bearing, rad_from_deg(random_.uniform(5.0, 40.0)));
      const double length_m = std::min(height_m_ * random_.uniform(0.5, 0.9), kLongestLeaf_m);
      if (i % fewer() != 0) continue;
      // As long as near, so that the plant's outline stays.
      add_leaf(LeafKind::kOlive, root_W_ + 0.01 * Vector3d::UnitZ(), along, length_m, colour,
               fewer());
    }
  }

  void grow_herb() {
    const Vector3f colour = shaded(kHerbLeaf, random_);
    const double bearing = random_.uniform(0.0, 2.0 * kPi);
    const double lean_rad = rad_from_deg(random_.uniform(0.0, 20.0));
    const Vector3d top_W = root_W_ + height_m_ * direction_at(bearing, 0.5 * kPi - lean_rad);
    const double radius_m = std::clamp(0.012 * height_m_, 0.001, 0.004);
    const std::array<TubePoint, 2> stem = {{{root_W_, radius_m}, {top_W, 0.4 * radius_m}}};
    append_tube(mesh_, stem, 3, kHerbStem);
    constexpr double kLeafEvery_m = 0.015;
    const int leaves = std::clamp(static_cast<int>(height_m_ / kLeafEvery_m), 5, 30);
    for (int i = 0; i < leaves; ++i) {
      const double share = (i + 1.0) / leaves;
      const Vector3d along =
          direction_at(kGoldenAngle_rad * i, rad_from_deg(random_.uniform(-10.0, 50.0)));
      const double length_m = std::clamp(0.35 * height_m_, 0.02, 0.07) * (1.0 - 0.6 * share) *
                              random_.uniform(0.8, 1.2);
      if (i % fewer() != 0) continue;
      add_leaf(LeafKind::kApple, root_W_ + share * (top_W - root_W_), along, length_m, colour);
    }
  }

  TriangleMesh& mesh_;
  Vector3d root_W_;
  double height_m_;
  int level_;
  RandomStream random_;
};

}  // namespace

const ParameterTable<WeedParams>& weed_table() {
  using P = WeedParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("per_m2", "1/m2", &P::per_m2, above(0.0, 50.0), "plants on the strip")
          .number("height_m", "m", &P::height_m, between(0.03, 1.0),
                  "of a mean upright plant; single ones are 0.4 to 1.6 times as high")
          .number("strip_width_m", "m", &P::strip_width_m, between(0.1, 3.0),
                  "width of the strip, the row in its middle");
  return table;
}

std::vector<Weed> place_weeds(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                              double start_m, double end_m, const WeedParams& params,
                              RandomStream random) {
  // Rounded up as often as makes the mean right.
  const double expected = params.per_m2 * params.strip_width_m * (end_m - start_m);
  const int count = static_cast<int>(expected + random.uniform());
  std::vector<Weed> weeds;
  for (int i = 0; i < count; ++i) {
    const double s_m = random.uniform(start_m, end_m);
    const double left_m = params.strip_width_m * random.uniform(-0.5, 0.5);
    const Eigen::Vector2d along = row.direction_W(s_m);
    const Eigen::Vector2d p_W = row.point_W(s_m) + left_m * Eigen::Vector2d(-along.y(), along.x());
    weeds.push_back({{p_W.x(), p_W.y(), ground(p_W.x(), p_W.y())},
                     params.height_m * random.uniform(0.4, 1.6),
                     random.next_u64()});
  }
  return weeds;
}

TriangleMesh make_weed_mesh(std::span<const Weed> weeds, int level) {
  TriangleMesh mesh;
  for (const Weed& weed : weeds) {
    if (level == 0) mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    WeedGrower(mesh, weed, level).grow();
  }
  return mesh;
}

void check_weeds(std::span<const mapping::RowCurve> rows, const WeedParams& params) {
  constexpr double kMost = 300'000.0;  // 3 GB with the trees of rays
  double length_m = 0.0;
  for (const mapping::RowCurve& row : rows) length_m += row.length_m();
  const double count = length_m * params.strip_width_m * params.per_m2;
  if (count <= kMost) return;
  throw ConfigError(fmt::format(
      "weeds.per_m2 = {:.6g} 1/m2 gives {:.0f} plants in strips of {:.6g} m under "
      "{:.0f} m of rows, must be <= {:.3g} 1/m2: {:.0f} plants",
      params.per_m2, count, params.strip_width_m, length_m, params.per_m2 * kMost / count, kMost));
}

void plant_weeds(WorldModel& world, std::span<const mapping::RowCurve> rows,
                 const mapping::GroundHeight& ground, const WeedParams& params, std::uint64_t seed,
                 MeshStore& store) {
  constexpr double kChunk_m = 7.0;  // about as long as the vines'
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int chunks = std::max(1, static_cast<int>(rows[i].length_m() / kChunk_m));
    const double length_m = rows[i].length_m() / chunks;
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const std::string chunk_name = fmt::format("weeds/row_{:02}/chunk_{:02}", i, chunk);
      const std::vector<Weed> weeds =
          place_weeds(rows[i], ground, chunk * length_m, (chunk + 1) * length_m, params,
                      RandomStream(seed, "", "world.plants." + chunk_name));
      if (weeds.empty()) continue;
      for (int level = 0; level < 3; ++level) {
        const std::string name = fmt::format("{}#lod{}", chunk_name, level);
        MeshInstance instance =
            plant_instance(name, store.get(name, [&] { return make_weed_mesh(weeds, level); }),
                           SurfaceClass::kCanopy);
        instance.label = Label::kWeed;
        instance.collides = false;
        if (level > 0) instance.light = Light::kPasses;
        world.meshes.push_back(std::move(instance));
      }
    }
  }
}

}  // namespace vinerow::worlds
