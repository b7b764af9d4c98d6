#include "worlds/mesh/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/mesh_file.h"
#include "engine/math/angles.h"
#include "worlds/mapping/map_parameters.h"
#include "worlds/mesh/sdf_rows.h"
#include "worlds/parts/common.h"
#include "worlds/parts/row_map.h"
#include "worlds/parts/terrain.h"
#include "worlds/parts/vine_rows.h"

namespace vinerow::worlds {
namespace {

const std::vector<std::string> kSurfaces = {"terrain", "canopy", "post",
                                            "trunk",   "wire",   "obstacle"};

std::vector<ParameterSpec> item_fields() {
  return {
      required(path_parameter("file", "mesh file: OBJ, STL, DAE, glTF, GLB or PLY")),
      text_parameter("name", "", "name of the object; default: the file's name"),
      number_parameter("x_m", "m", 0, -1e5, 1e5, "position east"),
      number_parameter("y_m", "m", 0, -1e5, 1e5, "position north"),
      number_parameter("z_m", "m", 0, -1e4, 1e4, "position up"),
      number_parameter("roll_deg", "deg", 0, -360, 360, "turn about x, first"),
      number_parameter("pitch_deg", "deg", 0, -360, 360, "turn about y, second"),
      number_parameter("yaw_deg", "deg", 0, -360, 360, "turn about z, third"),
      positive_parameter("scale", "", 1, "factor on all axes"),
      choice_parameter("up_axis", "auto", {"auto", "y", "z"},
                       "axis of the file that points up; auto: what the file says, else z"),
      optional(positive_parameter(
          "unit_m", "m", 1, "metres per unit of the file; default: what the file says, else 1")),
      choice_parameter("surface", "obstacle", kSurfaces, "what the object is"),
      boolean_parameter("collides", true, "whether vehicles and rays meet it"),
      boolean_parameter("visible", true, "whether pictures show it")};
}

PartSpec mesh_spec() {
  PartSpec spec;
  spec.name = "mesh";
  spec.description = "mesh files placed by pose, an SDF world's includes, or both";
  spec.parameters = concatenate(
      {{group_list_parameter("items", item_fields(), "mesh files and where they stand"),
        path_parameter("sdf_file", "SDF world whose includes are read for models and poses"),
        text_list_parameter(
            "model_folders", {},
            "folders with SDF models, absolute or beside sdf_file; default: ../models of sdf_file"),
        text_parameter("vine_model", "vine", "models whose names begin so are pieces of vine rows"),
        positive_parameter("vine_piece_length_m", "m", 6,
                           "length of one such piece along its x axis"),
        choice_parameter("ground", "auto", {"auto", "none", "flat"},
                         "flat height field under everything; auto: if no item is terrain"),
        number_parameter("ground_margin_m", "m", 8, 0, 500,
                         "of the flat ground beyond the objects"),
        positive_parameter("vine_spacing_m", "m", 1.0, "between vines of a stand-in row")},
       terrain_parameters(0),
       canopy_parameters(),
       trellis_parameters(),
       planting_parameters(),
       origin_parameters(0, 0, 0),
       surroundings_parameters(),
       map_parameters()});
  return spec;
}

SurfaceClass surface_of(const std::string& name) {
  const auto found = std::find(kSurfaces.begin(), kSurfaces.end(), name);
  constexpr SurfaceClass kClasses[] = {SurfaceClass::kTerrain, SurfaceClass::kCanopy,
                                       SurfaceClass::kPost,    SurfaceClass::kTrunk,
                                       SurfaceClass::kWire,    SurfaceClass::kObstacle};
  return kClasses[found - kSurfaces.begin()];
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

void place_item(const ParameterSet& item, MeshLibrary& library) {
  io::MeshFileOptions options;
  options.scale = Eigen::Vector3d::Constant(item.number("scale"));
  if (item.text("up_axis") == "y") options.up_axis = io::UpAxis::kY;
  if (item.text("up_axis") == "z") options.up_axis = io::UpAxis::kZ;
  if (item.has("unit_m")) options.unit_m = item.number("unit_m");
  const std::filesystem::path file = item.text("file");
  const io::MeshFile& loaded = library.load(file.string(), options);
  Pose X_WM;
  X_WM.p = {item.number("x_m"), item.number("y_m"), item.number("z_m")};
  X_WM.q = quaternion_from_rpy({rad_from_deg(item.number("roll_deg")),
                                rad_from_deg(item.number("pitch_deg")),
                                rad_from_deg(item.number("yaw_deg"))});
  const std::string name = item.text("name").empty() ? file.stem().string() : item.text("name");
  library.place(name, loaded, X_WM, surface_of(item.text("surface")), item.boolean("collides"),
                item.boolean("visible"));
}

std::vector<std::filesystem::path> model_folders(const ParameterSet& parameters) {
  const std::filesystem::path beside =
      std::filesystem::path(parameters.text("sdf_file")).parent_path();
  std::vector<std::filesystem::path> folders;
  for (const std::string& folder : parameters.texts("model_folders"))
    folders.push_back(beside / folder);
  if (folders.empty()) folders = {beside / ".." / "models", beside / "models", beside};
  return folders;
}

/// Places the models that are there; tells those that are not, with what stands in for them.
void place_includes(const std::vector<io::SdfInclude>& includes, const ParameterSet& parameters,
                    MeshLibrary& library, WorldModel& world) {
  const std::string& vine_model = parameters.text("vine_model");
  std::map<std::string, int> missing;
  for (const io::SdfInclude& include : includes) {
    const bool is_light = include.model == "sun";
    if (is_light) continue;
    const auto folder = io::find_sdf_model(include.model, model_folders(parameters));
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
    world.notes.push_back(fmt::format(
        "{}: model '{}' (included {} times) is missing; {}", parameters.text("sdf_file"), model,
        count, vine ? "a trellis row of our own stands in" : "it is left out"));
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
                     const ParameterSet& parameters, const VinePlanting& planting) {
  const GroundHeight ground = [&world](double x, double y) {
    return world.terrain ? world.terrain->height_m(x, y) : 0.0;
  };
  const double spacing_m = parameters.number("vine_spacing_m");
  std::vector<VineRow> vine_rows;
  for (const RowCurve& row : rows) {
    const double length_m = row.length_m();
    VineRow vines{
        row, regular_vines(length_m, spacing_m, 0.0, RandomStream(0, "", "")), spacing_m, {}};
    if (parameters.boolean("posts")) {
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
  const std::vector<ParameterSet>& items = parameters.groups("items");
  if (items.empty() && !parameters.has("sdf_file")) {
    throw ConfigError("mesh: nothing to load, give items (mesh files) or sdf_file");
  }
  auto world = std::make_unique<WorldModel>();
  world->name = "mesh";
  world->origin = read_origin(parameters);
  read_surroundings(parameters, context.seed, *world);
  const VinePlanting planting = read_planting(parameters);

  MeshLibrary library(*world);
  bool has_ground = false;
  for (const ParameterSet& item : items) {
    place_item(item, library);
    has_ground = has_ground || item.text("surface") == "terrain";
  }
  std::vector<RowCurve> rows;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  if (parameters.has("sdf_file")) {
    const std::vector<io::SdfInclude> includes = io::read_sdf_includes(parameters.text("sdf_file"));
    place_includes(includes, parameters, library, *world);
    rows = find_sdf_rows(includes, parameters.text("vine_model"),
                         parameters.number("vine_piece_length_m"));
    plane = fit_ground_plane(includes, parameters.text("vine_model"));
  }

  Eigen::AlignedBox2d box = extent_of(*world, rows);
  const std::string& ground = parameters.text("ground");
  if (ground == "flat" || (ground == "auto" && !has_ground)) {
    const double margin_m = std::max(parameters.number("ground_margin_m"), 1.0);
    const Eigen::Vector2d margin(margin_m, margin_m);
    const Eigen::AlignedBox2d ground_box(Eigen::Vector2d(box.min() - margin),
                                         Eigen::Vector2d(box.max() + margin));
    TerrainShape shape;
    shape.centre_W = ground_box.center();
    shape.gradient = plane.tail<2>();
    shape.centre_height_m = plane.x() + shape.gradient.dot(shape.centre_W);
    world->terrain = build_terrain(parameters, planting.seed, world->origin, shape, ground_box);
  }
  if (!rows.empty()) plant_stand_ins(*world, rows, parameters, planting);
  fill_occupancy(parameters, *world, {}, row_end_margin_m(planting, parameters.boolean("posts")));
  world->spawn_points.push_back({"centre", box.center(), 0.0});
  return world;
}

}  // namespace

void register_mesh(Registry& registry) {
  registry.add_world(mesh_spec(), make_mesh_world);
}

}  // namespace vinerow::worlds
