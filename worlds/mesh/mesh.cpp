#include "worlds/mesh/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/mesh_file.h"
#include "worlds/mesh/mesh_params.h"
#include "worlds/mesh/sdf_rows.h"
#include "worlds/parts/row_map.h"

namespace vinerow::worlds {
namespace {

PartSpec mesh_spec() {
  PartSpec spec;
  spec.name = "mesh";
  spec.description = "mesh files placed by pose, an SDF world's includes, or both";
  spec.parameters = mesh_world_table().specs();
  return spec;
}

/// Loads files once, however often they are placed, and keeps their notes.
class MeshLibrary {
 public:
  explicit MeshLibrary(WorldModel& world) : world_(world) {}

  const io::MeshFile& load(const std::string& file, const io::MeshFileOptions& options) {
    const std::string key =
        fmt::format("{}|{}|{}|{}|{}|{}", file, static_cast<int>(options.up_axis), options.unit_m,
                    options.scale.x(), options.scale.y(), options.scale.z());
    const auto known = files_.find(key);
    if (known != files_.end()) return known->second;
    io::MeshFile& loaded = files_[key] = io::load_mesh(file, options);
    for (const std::string& note : loaded.notes) {
      if (std::find(world_.notes.begin(), world_.notes.end(), note) == world_.notes.end()) {
        world_.notes.push_back(note);
      }
    }
    return loaded;
  }

  void place(const std::string& name, const io::MeshFile& file, const Pose& X_WM,
             SurfaceClass surface, bool collides, bool visible) {
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
      const io::MeshPart& part = file.parts[i];
      MeshInstance instance;
      instance.name = file.parts.size() == 1 ? name : fmt::format("{}/{}_{}", name, i, part.name);
      instance.mesh = part.mesh;
      instance.X_WM = X_WM;
      instance.surface = surface;
      instance.material = part.material;
      instance.collides = collides;
      instance.visible = visible;
      world_.meshes.push_back(std::move(instance));
    }
  }

 private:
  WorldModel& world_;
  std::map<std::string, io::MeshFile> files_;
};

void place_item(const MeshItem& item, MeshLibrary& library) {
  io::MeshFileOptions options;
  options.scale = Eigen::Vector3d::Constant(item.scale);
  options.up_axis = item.up_axis;
  options.unit_m = item.unit_m.value_or(options.unit_m);
  const io::MeshFile& loaded = library.load(item.file.string(), options);
  Pose X_WM;
  X_WM.p = item.p_WM;
  X_WM.q = quaternion_from_rpy(item.rpy);
  const std::string name = item.name.empty() ? item.file.stem().string() : item.name;
  library.place(name, loaded, X_WM, item.surface, item.collides, item.visible);
}

std::vector<std::filesystem::path> model_folders(const MeshWorldParams& params) {
  const std::filesystem::path beside = params.sdf_file.parent_path();
  std::vector<std::filesystem::path> folders;
  for (const std::string& folder : params.model_folders) folders.push_back(beside / folder);
  if (folders.empty()) folders = {beside / ".." / "models", beside / "models", beside};
  return folders;
}

/// Places the models that are there; tells those that are not, with what stands in for them.
void place_includes(const std::vector<io::SdfInclude>& includes, const MeshWorldParams& params,
                    MeshLibrary& library, WorldModel& world) {
  const std::string& vine_model = params.vine_model;
  std::map<std::string, int> missing;
  for (const io::SdfInclude& include : includes) {
    const bool is_light = include.model == "sun";
    if (is_light) continue;
    const auto folder = io::find_sdf_model(include.model, model_folders(params));
    if (!folder) {
      ++missing[include.model];
      continue;
    }
    for (const io::SdfMesh& mesh : io::read_sdf_meshes(*folder)) {
      std::error_code error;
      if (!std::filesystem::is_regular_file(mesh.file, error)) {
        world.notes.push_back(
            fmt::format("model '{}': mesh '{}' is missing", include.model, mesh.uri));
        continue;
      }
      io::MeshFileOptions options;
      options.scale = mesh.scale;
      options.up_axis = io::UpAxis::kAuto;
      library.place(include.name, library.load(mesh.file.string(), options),
                    include.X_WM * mesh.X_MG, SurfaceClass::kObstacle, true, true);
    }
  }
  for (const auto& [model, count] : missing) {
    const bool vine = !vine_model.empty() && model.rfind(vine_model, 0) == 0;
    world.notes.push_back(
        fmt::format("{}: model '{}' (included {} times) is missing; {}", params.sdf_file.string(),
                    model, count, vine ? "a trellis row of our own stands in" : "it is left out"));
  }
}

/// The box around every placed mesh and row, in the plane.
Eigen::AlignedBox2d extent_of(const WorldModel& world, const std::vector<RowCurve>& rows) {
  Eigen::AlignedBox2d box;
  for (const MeshInstance& instance : world.meshes) {
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      box.extend(Eigen::Vector2d((instance.X_WM * v.cast<double>()).head<2>()));
    }
  }
  for (const RowCurve& row : rows) {
    for (const Eigen::Vector2d& p : row.points_W()) box.extend(p);
  }
  if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
  return box;
}

void plant_stand_ins(WorldModel& world, const std::vector<RowCurve>& rows,
                     const MeshWorldParams& params) {
  const VinePlanting& planting = params.planting;
  const GroundHeight ground = [&world](double x, double y) {
    return world.terrain ? world.terrain->height_m(x, y) : 0.0;
  };
  const double spacing_m = params.vine_spacing_m;
  std::vector<VineRow> vine_rows;
  for (const RowCurve& row : rows) {
    const double length_m = row.length_m();
    VineRow vines{
        row, regular_vines(length_m, spacing_m, 0.0, RandomStream(0, "", "")), spacing_m, {}};
    if (planting.trellis.posts) {
      vines.post_s_m = spread_posts(0.0, length_m, planting.trellis.post_spacing_m);
    }
    vine_rows.push_back(std::move(vines));
  }
  MemoryMeshStore store;
  plant_vine_rows(world, vine_rows, ground, planting, store);
  world.rows = make_row_map(rows, ground, planting.canopy, parcel_boundary(rows, 8.0, 3.0));
  add_alley_spawn_points(world);
}

std::unique_ptr<WorldModel> make_mesh_world(const ParameterSet& parameters,
                                            const WorldContext& context) {
  const MeshWorldParams params = mesh_world_table().read(parameters, "");
  if (params.items.empty() && params.sdf_file.empty()) {
    throw ConfigError("mesh: nothing to load, give items (mesh files) or sdf_file");
  }
  auto world = std::make_unique<WorldModel>();
  world->name = "mesh";
  world->origin = params.origin;
  set_surroundings(params.surroundings, context.seed, *world);
  world->depends_on_seed = false;  // plants have a seed of their own

  MeshLibrary library(*world);
  bool has_ground = false;
  for (const MeshItem& item : params.items) {
    place_item(item, library);
    has_ground = has_ground || item.surface == SurfaceClass::kTerrain;
  }
  std::vector<RowCurve> rows;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  if (!params.sdf_file.empty()) {
    const std::vector<io::SdfInclude> includes = io::read_sdf_includes(params.sdf_file);
    place_includes(includes, params, library, *world);
    rows = find_sdf_rows(includes, params.vine_model, params.vine_piece_length_m);
    plane = fit_ground_plane(includes, params.vine_model);
  }

  Eigen::AlignedBox2d box = extent_of(*world, rows);
  if (params.ground == MeshGround::kFlat || (params.ground == MeshGround::kAuto && !has_ground)) {
    const double margin_m = std::max(params.ground_margin_m, 1.0);
    const Eigen::Vector2d margin(margin_m, margin_m);
    const Eigen::AlignedBox2d ground_box(Eigen::Vector2d(box.min() - margin),
                                         Eigen::Vector2d(box.max() + margin));
    TerrainShape shape;
    shape.centre_W = ground_box.center();
    shape.gradient = plane.tail<2>();
    shape.centre_height_m = plane.x() + shape.gradient.dot(shape.centre_W);
    world->terrain =
        build_terrain(params.terrain, params.planting.seed, world->origin, shape, ground_box);
  }
  if (!rows.empty()) plant_stand_ins(*world, rows, params);
  fill_occupancy(params.map, *world, {}, row_end_margin_m(params.planting));
  world->spawn_points.push_back({"centre", box.center(), 0.0});
  return world;
}

}  // namespace

void register_mesh(Registry& registry) {
  registry.add_world(mesh_spec(), make_mesh_world);
}

}  // namespace vinerow::worlds
