#include "tools/replay/replay_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/render/builtin_textures.h"
#include "engine/render/culling.h"
#include "tools/replay/replay_decimate.h"
#include "tools/replay/replay_glb.h"
#include "tools/replay/replay_ground.h"

namespace vinerow::tools {
namespace {

using nlohmann::json;

/// Largest thinning factor of the nearest leaves; beyond it the next coarser level is used. Chosen.
constexpr int kMaxThinning = 6;

/// Meshes of one instance or of its levels of detail, the nearest first.
using Group = std::vector<const MeshInstance*>;

/// Visible groups in the world's order, grouped as in the renderer.
std::vector<Group> visible_groups(const WorldModel& world) {
  std::vector<Group> groups;
  std::map<std::string, std::size_t> by_name;
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.visible || !instance.mesh || instance.mesh->triangles.empty()) continue;
    const render::LodName name = render::split_lod_name(instance.name);
    std::size_t place = groups.size();
    if (name.level >= 0) place = by_name.try_emplace(name.base, place).first->second;
    if (place == groups.size()) groups.emplace_back();
    groups[place].push_back(&instance);
  }
  for (Group& group : groups) {
    std::stable_sort(group.begin(), group.end(), [](const MeshInstance* a, const MeshInstance* b) {
      return a->name < b->name;
    });
  }
  return groups;
}

bool shows_leaves(const MeshInstance& instance) {
  return instance.material.leaf_cards &&
         instance.mesh->uvs.size() == instance.mesh->vertices.size();
}

/// Approximate size of a mesh in the glTF scene.
std::size_t estimated_bytes(const TriangleMesh& mesh, bool cards) {
  // Positions and normals, colours, texture coordinates; creases of solids double some vertices.
  const std::size_t vertex = cards ? 20 : mesh.colours.empty() ? 12 : 20;
  const std::size_t vertices =
      cards ? mesh.vertices.size() : std::min(2 * mesh.vertices.size(), 3 * mesh.triangles.size());
  return vertices * vertex + mesh.triangles.size() * (vertices < 65'536 ? 6 : 12);
}

/// Leaf picture that suits most cards of a mesh.
const char* picture_of(const render::PreparedMesh& mesh) {
  int counts[3] = {};
  for (const render::GpuVertex& v : mesh.vertices) {
    const int layer = v.colour[3] % render::kLeafLayersPerKind;
    ++counts[layer >= render::kLeafClump ? 2 : layer >= render::kLeafSpray ? 1 : 0];
  }
  constexpr const char* kNames[] = {"leaf", "spray", "clump"};
  return kNames[std::max_element(counts, counts + 3) - counts];
}

class SceneMaker {
 public:
  SceneMaker(const ReplayInput& input, const ReplayLimits& limits)
      : input_(input), limits_(limits) {}

  ReplayScene make() {
    add_ground();
    add_world();
    add_vehicles();
    if (!input_.world->scenery.empty()) {
      notes_.push_back("fields, tracks and trees around the parcel are shown in the pictures only");
    }
    return {scene_.bytes(), std::move(notes_)};
  }

 private:
  /// A mesh of the glTF file has one material.
  using MeshKey = std::tuple<const TriangleMesh*, bool, std::array<float, 3>>;
  static MeshKey key_of(const std::shared_ptr<const TriangleMesh>& mesh, bool cards,
                        const Material& look) {
    return {mesh.get(), cards, {look.colour.x(), look.colour.y(), look.colour.z()}};
  }

  struct Kept {
    int mesh = -1;
    std::string picture;  ///< of leaf cards
  };

  void add_ground() {
    const WorldModel& world = *input_.world;
    if (!world.terrain) return;
    const ReplayTerrain terrain = thin_terrain(*world.terrain, focus(), limits_.terrain_samples);
    if (terrain.coarse.cell_m > world.terrain->cell_m) {
      const double near_m = terrain.fine ? terrain.fine->cell_m : terrain.coarse.cell_m;
      const std::string elsewhere =
          terrain.fine
              ? fmt::format(" around the rows and every {:.2g} m elsewhere", terrain.coarse.cell_m)
              : "";
      notes_.push_back(fmt::format("the ground has a point every {:.2g} m{}", near_m, elsewhere));
    }
    Material material;
    material.name = "ground";
    material.colour = {0.12f, 0.13f, 0.06f};
    const int ground = scene_.add_material(material, false);
    int number = 0;
    std::vector<render::PreparedMesh> meshes = terrain_meshes(terrain.coarse, terrain.hole);
    if (terrain.fine) {
      for (render::PreparedMesh& mesh : terrain_meshes(*terrain.fine)) {
        meshes.push_back(std::move(mesh));
      }
    }
    for (const render::PreparedMesh& mesh : meshes) {
      if (mesh.indices.empty()) continue;
      const std::string name = fmt::format("terrain_{}", number++);
      scene_.add_node(name, scene_.add_mesh(name, mesh, ground, false, false), Pose{},
                      {{"part", "terrain"}});
    }
    number = 0;
    for (const render::PreparedMesh& mesh : surroundings_meshes(*world.terrain)) {
      const std::string name = fmt::format("surroundings_{}", number++);
      scene_.add_node(name, scene_.add_mesh(name, mesh, ground, false, false), Pose{},
                      {{"part", "surroundings"}});
    }
  }

  /// Area of the rows with a headland; without rows, the area that vehicles drive or fly low over.
  Eigen::AlignedBox2d focus() const {
    constexpr double kHeadland_m = 14.0;
    Eigen::AlignedBox2d box;
    for (const PlantRow& row : input_.world->rows->rows) {
      for (const Eigen::Vector3d& p : row.line_W) box.extend(p.head<2>());
    }
    if (box.isEmpty()) {
      for (const auto& [name, trace] : input_.trace->vehicles) {
        for (const Odometry& truth : trace.truth.values) box.extend(truth.X_WB.p.head<2>());
      }
    }
    if (box.isEmpty()) return box;
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kHeadland_m);
    return {Eigen::Vector2d(box.min() - margin), Eigen::Vector2d(box.max() + margin)};
  }

  void add_world() {
    const std::vector<Group> groups = visible_groups(*input_.world);
    const LeafDetail leaves = leaf_detail(groups);
    const double cell_m = solid_cell(groups);
    int number = 0;
    for (const Group& group : groups) {
      const bool cards = shows_leaves(*group.front());
      // Anything but foliage uses its coarsest level: thin posts and stems look the same.
      const std::size_t first =
          cards ? std::min(leaves.finest, group.size() - 1) : group.size() - 1;
      for (std::size_t level = first; level < group.size(); ++level) {
        add_instance(*group[level], number, static_cast<int>(level), group.size() - first > 1,
                     cards ? 0.0 : cell_m, cards && level == first ? leaves.keep_every : 1);
      }
      ++number;
    }
  }

  /// Detail of leaves: their finest level, and the thinning factor of its cards.
  struct LeafDetail {
    std::size_t finest = 0;
    int keep_every = 1;
  };

  LeafDetail leaf_detail(const std::vector<Group>& groups) {
    LeafDetail detail;
    while (leaf_bytes(groups, detail) > limits_.leaf_bytes && detail.finest < 8) {
      if (++detail.keep_every <= kMaxThinning) continue;
      detail = {detail.finest + 1, 1};
    }
    if (detail.finest > 0 || detail.keep_every > 1) {
      notes_.push_back("leaves near the camera are fewer and larger than in the world");
    }
    return detail;
  }

  static std::size_t leaf_bytes(const std::vector<Group>& groups, const LeafDetail& detail) {
    std::map<const TriangleMesh*, std::size_t> bytes;
    for (const Group& group : groups) {
      if (!shows_leaves(*group.front())) continue;
      const std::size_t first = std::min(detail.finest, group.size() - 1);
      for (std::size_t l = first; l < group.size(); ++l) {
        const std::size_t whole = estimated_bytes(*group[l]->mesh, true);
        bytes[group[l]->mesh.get()] =
            l == first ? whole / static_cast<std::size_t>(detail.keep_every) : whole;
      }
    }
    std::size_t sum = 0;
    for (const auto& [mesh, own] : bytes) sum += own;
    return sum;
  }

  /// Grid cell for simplifying meshes other than leaves, m; 0: no simplification.
  double solid_cell(const std::vector<Group>& groups) {
    std::map<const TriangleMesh*, std::size_t> bytes;
    for (const Group& group : groups) {
      const MeshInstance& coarsest = *group.back();
      if (shows_leaves(*group.front())) continue;
      bytes[coarsest.mesh.get()] = estimated_bytes(*coarsest.mesh, false);
    }
    std::size_t sum = 0;
    for (const auto& [mesh, own] : bytes) sum += own;
    double cell_m = 0.0;
    while (sum > limits_.solid_bytes && cell_m < 100.0) {
      cell_m = cell_m == 0.0 ? 0.02 : 1.5 * cell_m;
      sum = 0;
      for (auto& [mesh, own] : bytes)
        sum += estimated_bytes(cluster_vertices(*mesh, cell_m), false);
    }
    if (cell_m > 0.0) {
      notes_.push_back(
          fmt::format("meshes are simplified: details smaller than {:.2g} m are "
                      "merged",
                      cell_m));
    }
    return cell_m;
  }

  void add_instance(const MeshInstance& instance, int group, int level, bool has_levels,
                    double cell_m, int keep_every) {
    const Kept& kept = find_mesh(instance, cell_m, keep_every);
    if (kept.mesh < 0) return;
    json extras = {{"part", "world"}, {"surface", to_string(instance.surface)}};
    if (has_levels) {
      extras["group"] = group;
      extras["level"] = level;
    }
    if (!kept.picture.empty()) extras["cards"] = kept.picture;
    scene_.add_node(instance.name, kept.mesh, instance.X_WM, std::move(extras));
  }

  const Kept& find_mesh(const MeshInstance& instance, double cell_m, int keep_every) {
    const bool cards = shows_leaves(instance);
    const auto [place, is_new] =
        meshes_.try_emplace(key_of(instance.mesh, cards, instance.material));
    if (!is_new) return place->second;
    render::CardKind kind = render::CardKind::kNone;
    if (cards) {
      kind = instance.material.texture == "builtin:tree_leaf" ? render::CardKind::kTree
                                                              : render::CardKind::kVine;
    }
    const render::PreparedMesh mesh =
        render::prepare_mesh(cards          ? thin_cards(*instance.mesh, keep_every)
                             : cell_m > 0.0 ? cluster_vertices(*instance.mesh, cell_m)
                                            : *instance.mesh,
                             kind);
    if (mesh.indices.empty()) return place->second;
    if (cards) place->second.picture = picture_of(mesh);
    place->second.mesh = add_prepared(instance.name, mesh, instance.material,
                                      cards || !instance.mesh->colours.empty(), cards);
    return place->second;
  }

  int add_prepared(const std::string& name, const render::PreparedMesh& mesh, Material look,
                   bool coloured, bool cards) {
    if (look.name.empty()) look.name = "plain";
    look.leaf_cards = cards;
    const int material = scene_.add_material(look, !mesh.closed);
    return scene_.add_mesh(name, mesh, material, coloured, cards);
  }

  void add_vehicles() {
    for (std::size_t v = 0; v < input_.vehicles->size(); ++v) {
      const std::string& name = input_.scenario->vehicles[v].name;
      const std::vector<VehicleLink>& links = (*input_.vehicles)[v]->links();
      const auto trace = input_.trace->vehicles.find(name);
      if (trace == input_.trace->vehicles.end() || trace->second.truth.empty()) continue;
      const std::vector<Pose> X_WL = trace->second.links_at(input_.trace->first);
      for (std::size_t l = 0; l < links.size(); ++l) {
        const Pose X_WL0 = l < X_WL.size() ? X_WL[l] : trace->second.truth.values.front().X_WB;
        const int frame = scene_.add_frame(fmt::format("{}/{}", name, links[l].name), X_WL0,
                                           {{"part", "link"}, {"vehicle", v}, {"link", l}});
        if (!links[l].mesh) continue;
        const auto [place, is_new] =
            meshes_.try_emplace(key_of(links[l].mesh, false, links[l].material));
        if (is_new) {
          const render::PreparedMesh mesh =
              render::prepare_mesh(*links[l].mesh, render::CardKind::kNone);
          if (mesh.indices.empty()) continue;
          place->second.mesh = add_prepared(links[l].name, mesh, links[l].material,
                                            !links[l].mesh->colours.empty(), false);
        }
        if (place->second.mesh < 0) continue;
        scene_.add_node(links[l].name, place->second.mesh, Pose{}, {}, frame);
      }
    }
  }

  const ReplayInput& input_;
  const ReplayLimits& limits_;
  GlbScene scene_;
  std::map<MeshKey, Kept> meshes_;
  std::vector<std::string> notes_;
};

}  // namespace

ReplayScene make_replay_scene(const ReplayInput& input, const ReplayLimits& limits) {
  return SceneMaker(input, limits).make();
}

}  // namespace vinerow::tools
