#include "worlds/plants/trees.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "worlds/parts/foliage.h"
#include "worlds/parts/leaf_area.h"
#include "worlds/parts/primitives.h"
#include "worlds/plants/plant_instance.h"

namespace vinerow::worlds {
namespace {

/// Crown of one variant: an ellipsoid with lumps, never outside the parameters' box.
struct Crown {
  Eigen::Vector3d centre;
  Eigen::Vector3d half_axes_m;
  double lump;  // share of the radius that lumps take away at most
  double phases[3];
};

Crown make_crown(const TreeParams& params, RandomStream random) {
  Crown crown;
  const double size = random.uniform(0.85, 1.0);
  const double top = params.crown_base_m + (params.height_m - params.crown_base_m) * size;
  crown.centre = {0.0, 0.0, 0.5 * (params.crown_base_m + top)};
  crown.half_axes_m = {0.5 * params.crown_length_m * size, 0.5 * params.crown_width_m * size,
                       0.5 * (top - params.crown_base_m)};
  crown.lump = 0.12;
  for (double& phase : crown.phases) phase = random.uniform(0.0, 2.0 * kPi);
  return crown;
}

/// Latitude-longitude sphere, lumpy, closed.
TriangleMesh make_crown_hull(const Crown& crown) {
  constexpr int kRings = 9, kSides = 14;
  TriangleMesh mesh;
  const auto point = [&](double polar, double azimuth) {
    const Eigen::Vector3d d(std::sin(polar) * std::cos(azimuth),
                            std::sin(polar) * std::sin(azimuth), std::cos(polar));
    const double wave = std::sin(3.0 * azimuth + crown.phases[0]) * std::sin(2.0 * polar) +
                        std::sin(5.0 * azimuth + crown.phases[1]) * std::sin(3.0 * polar) +
                        std::sin(4.0 * d.z() + crown.phases[2]);
    const double r = 1.0 - crown.lump * (0.5 + wave / 6.0);
    return Eigen::Vector3d(crown.centre + r * d.cwiseProduct(crown.half_axes_m));
  };
  mesh.vertices.push_back(point(0.0, 0.0).cast<float>());
  for (int i = 1; i < kRings; ++i) {
    for (int k = 0; k < kSides; ++k) {
      mesh.vertices.push_back(point(kPi * i / kRings, 2.0 * kPi * k / kSides).cast<float>());
    }
  }
  mesh.vertices.push_back(point(kPi, 0.0).cast<float>());
  const auto at = [&](int ring, int side) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * kSides + side % kSides);
  };
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (int k = 0; k < kSides; ++k) {
    mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
    for (int i = 1; i + 1 < kRings; ++i) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
    mesh.triangles.push_back({last, at(kRings - 1, k + 1), at(kRings - 1, k)});
  }
  mesh.colours.assign(mesh.vertices.size(), Eigen::Vector3f(0.05f, 0.13f, 0.03f));
  calc_vertex_normals(mesh);
  return mesh;
}

TriangleMesh make_tree_trunk(const TreeParams& params, const Crown& crown, RandomStream random) {
  TriangleMesh mesh;
  const Eigen::Vector3f kBark(0.085f, 0.065f, 0.05f);
  const double r = params.trunk_radius_m;
  const double fork_m = 0.5 * (params.crown_base_m + crown.centre.z());
  const double bend_y = random.uniform(-0.06, 0.06), bend_x = random.uniform(-0.06, 0.06);
  const Eigen::Vector3d bend(bend_x, bend_y, 0.0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const std::array<TubePoint, 4> stem = {
      TubePoint{-0.15 * up, 1.5 * r}, TubePoint{0.1 * up, 1.15 * r},
      TubePoint{0.5 * fork_m * up + bend, r}, TubePoint{fork_m * up + 0.5 * bend, 0.85 * r}};
  append_tube(mesh, stem, 8, kBark);
  constexpr int kBoughs = 4;
  for (int i = 0; i < kBoughs; ++i) {
    const double azimuth = 2.0 * kPi * (i + random.uniform(0.1, 0.9)) / kBoughs;
    const Eigen::Vector3d out(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Eigen::Vector3d start = (fork_m - 0.1) * up + 0.5 * bend;
    const Eigen::Vector3d end =
        crown.centre + 0.6 * (out + 0.35 * up).normalized().cwiseProduct(crown.half_axes_m);
    const std::array<TubePoint, 3> bough = {TubePoint{start, 0.55 * r},
                                            TubePoint{0.5 * (start + end) + 0.08 * up, 0.4 * r},
                                            TubePoint{end, 0.15 * r}};
    append_tube(mesh, bough, 5, kBark);
  }
  return mesh;
}

}  // namespace

void plant_tree_row(WorldModel& world, int row_number, const mapping::RowCurve& row,
                    const std::vector<double>& tree_s_m, const mapping::GroundHeight& ground,
                    const TreeParams& params, MeshStore& store) {
  const auto random = [&](const std::string& name) {
    return RandomStream(params.seed, "", "world.plants." + name);
  };
  for (std::size_t i = 0; i < tree_s_m.size(); ++i) {
    const std::string tree = fmt::format("row_{:02}/tree_{:02}", row_number, i);
    RandomStream choice = random(tree);
    const auto variant =
        static_cast<int>(choice.next_u64() % static_cast<std::uint64_t>(params.variants));
    const std::string key = fmt::format("variant_{}", variant);
    const Crown crown = make_crown(params, random("crown." + key));
    // Trees grow plumb; every other one is turned by half a turn, which keeps its width across the
    // row.
    const Eigen::Vector2d p = row.point_W(tree_s_m[i]), d = row.direction_W(tree_s_m[i]);
    const double turn = choice.uniform() < 0.5 ? 0.0 : kPi;
    Pose X_WT;
    X_WT.p = {p.x(), p.y(), ground(p.x(), p.y())};
    X_WT.q = quaternion_from_rpy({0.0, 0.0, std::atan2(d.y(), d.x()) + turn});

    const auto add = [&](const char* what, SurfaceClass surface,
                         const std::shared_ptr<const TriangleMesh>& mesh) -> MeshInstance& {
      world.meshes.push_back(plant_instance(fmt::format("{}/{}", what, tree), mesh, surface));
      world.meshes.back().X_WM = X_WT;
      return world.meshes.back();
    };
    const CrownSpace space{crown.centre, crown.half_axes_m};
    const double area_m2 = params.leaves ? leaf_area_m2(*params.leaves, space) : 0.0;
    const bool is_bare = params.leaves && area_m2 <= 0.0;
    if (!is_bare) {
      MeshInstance& hull =
          add("crown_hull", SurfaceClass::kCanopy,
              store.get("crown_hull/" + key, [&] { return make_crown_hull(crown); }));
      hull.visible = false;
      hull.light = params.leaves ? Light::kPasses : Light::kMeets;
      if (params.leaves) {
        hull.foliage = foliage_in(*hull.mesh, area_m2, leaf_width_m(*params.leaves));
      }
    }
    add("tree_trunk", SurfaceClass::kTrunk, store.get("tree_trunk/" + key, [&] {
      return make_tree_trunk(params, crown, random("tree_trunk." + key));
    }));
    for (int level = 0; level < 3 && !is_bare; ++level) {
      const std::string mesh_name = fmt::format("crown/{}#lod{}", key, level);
      const auto mesh = store.get(mesh_name, [&] {
        return params.leaves ? make_tree_leaves(*params.leaves, space, level, random(mesh_name))
                             : make_crown_foliage(crown.centre, crown.half_axes_m,
                                                  tree_foliage_detail(params.leaf_cards, level),
                                                  random(mesh_name));
      });
      // A young tree has less than one of the large leaves that are seen from afar.
      if (mesh->triangles.empty()) continue;
      MeshInstance& leaves = add("crown", SurfaceClass::kCanopy, mesh);
      leaves.name += fmt::format("#lod{}", level);
      leaves.collides = false;
      if (!params.leaves) leaves.material = leaf_material();
      if (!params.leaves || level > 0) leaves.light = Light::kPasses;
    }
    if (!params.leaves) continue;
    const auto shoots =
        store.get("twigs/" + key, [&] { return make_twigs(space, random("twigs." + key)); });
    if (!shoots->triangles.empty()) {
      MeshInstance& twigs = add("twigs", SurfaceClass::kTrunk, shoots);
      twigs.collides = false;
      twigs.label = Label::kWood;  // a tree has one trunk
    }
    const auto fruit = store.get(
        "fruit/" + key, [&] { return make_fruit(*params.leaves, space, random("fruit." + key)); });
    if (fruit->triangles.empty()) continue;
    MeshInstance& hanging = add("fruit", SurfaceClass::kCanopy, fruit);
    hanging.collides = false;
    hanging.label = Label::kFruit;
  }
}

}  // namespace vinerow::worlds
