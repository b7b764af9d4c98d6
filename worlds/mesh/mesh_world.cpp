#include "worlds/mesh/mesh_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/meshes/mesh_file.h"
#include "engine/physics/check_world.h"
#include "engine/physics/world_scene.h"
#include "worlds/mapping/model/row_map.h"
#include "worlds/mesh/ground_meshes.h"
#include "worlds/mesh/mesh_params.h"
#include "worlds/mesh/sdf_rows.h"
#include "worlds/parts/alley_spawns.h"
#include "worlds/parts/leaf_area.h"

namespace vinerow::worlds {
namespace {

PartSpec mesh_spec() {
  PartSpec spec;
  spec.name = "mesh";
  spec.description = "mesh files placed by pose, an SDF world's includes, or both";
  mesh_world_table().add_to(spec);
  return spec;
}

/// Longest parcel (surveyed rows may be as long), and highest thing on it, such as a tree or a
/// mast.
constexpr double kMaxSide_m = 5000.0;
constexpr double kMaxHeight_m = 100.0;

/// Loads each file once and keeps its notes.
class MeshLibrary {
 public:
  explicit MeshLibrary(WorldModel& world) : world_(world) {}

  /// @param remedy  if the file turns out to be in millimetres
  MeshObject place(const std::string& name, const std::filesystem::path& path,
                   const io::MeshFileOptions& options, const Pose& X_WM, SurfaceClass surface,
                   bool collides, bool visible, const std::string& remedy) {
    const std::size_t files_before = files_.size();
    const io::MeshFile& file = load(path.string(), options);
    const std::size_t begin = world_.meshes.size();
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
    if (files_.size() > files_before) placed_.push_back({path, file.bounds(), begin, remedy});
    return {begin, world_.meshes.size()};
  }

  /// Notes the files that may be in millimetres. @pre the ground's meshes are marked
  void note_doubtful_units() {
    constexpr double kAny_m = std::numeric_limits<double>::infinity();
    for (const FirstPlace& placed : placed_) {
      const bool is_ground = world_.meshes[placed.begin].surface == SurfaceClass::kTerrain;
      add_note(io::doubt_unit(placed.file, placed.bounds,
                              {kMaxSide_m, kMaxSide_m, is_ground ? kAny_m : kMaxHeight_m},
                              placed.remedy));
    }
  }

  /// Sets what cameras call it, and its leaves.
  void describe(const MeshObject& object, std::optional<Label> label,
                std::optional<double> leaf_area_density_m2pm3) {
    for (std::size_t i = object.begin; i < object.end; ++i) {
      world_.meshes[i].label = label;
      if (leaf_area_density_m2pm3) {
        world_.meshes[i].foliage = Foliage{*leaf_area_density_m2pm3};
      }
    }
  }

 private:
  struct FirstPlace {
    std::filesystem::path file;
    Eigen::AlignedBox3d bounds;  // of the file
    std::size_t begin;           // of its meshes in the world
    std::string remedy;
  };

  const io::MeshFile& load(const std::string& file, const io::MeshFileOptions& options) {
    const std::string key =
        fmt::format("{}|{}|{}|{}|{}|{}", file, static_cast<int>(options.up_axis), options.unit_m,
                    options.scale.x(), options.scale.y(), options.scale.z());
    const auto known = files_.find(key);
    if (known != files_.end()) return known->second;
    io::MeshFile& loaded = files_[key] = io::load_mesh(file, options);
    for (const std::string& note : loaded.notes) add_note(note);
    return loaded;
  }

  void add_note(const std::string& note) {
    const auto known = std::find(world_.notes.begin(), world_.notes.end(), note);
    if (!note.empty() && known == world_.notes.end()) world_.notes.push_back(note);
  }

  WorldModel& world_;
  std::map<std::string, io::MeshFile> files_;
  std::vector<FirstPlace> placed_;
};

MeshObject place_item(const MeshItem& item, MeshLibrary& library) {
  io::MeshFileOptions options;
  options.scale = Eigen::Vector3d::Constant(item.scale);
  options.up_axis = item.up_axis;
  options.unit_m = item.unit_m.value_or(options.unit_m);
  Pose X_WM;
  X_WM.p = item.p_WM;
  X_WM.q = quaternion_from_rpy(item.rpy);
  const std::string name = item.name.empty() ? item.file.stem().string() : item.name;
  const MeshObject object =
      library.place(name, item.file, options, X_WM, item.surface.value_or(SurfaceClass::kObstacle),
                    item.collides, item.visible, "set its unit_m: 0.001");
  library.describe(object, item.label, item.leaf_area_density_m2pm3);
  return object;
}

std::vector<std::filesystem::path> model_folders(const MeshWorldParams& params) {
  const std::filesystem::path sdf_folder = params.sdf_file.parent_path();
  std::vector<std::filesystem::path> folders;
  for (const std::string& folder : params.model_folders) folders.push_back(sdf_folder / folder);
  if (folders.empty()) folders = {sdf_folder / ".." / "models", sdf_folder / "models", sdf_folder};
  return folders;
}

/// "box, cylinder": each once.
std::string words_once(std::vector<std::string> words) {
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return fmt::format("{}", fmt::join(words, ", "));
}

/// Places an SDF world's models.
class SdfModels {
 public:
  SdfModels(const MeshWorldParams& params, MeshLibrary& library, WorldModel& world)
      : params_(params), folders_(model_folders(params)), library_(library), world_(world) {}

  /// Places the models that are found, and notes what replaces the others.
  void place(const std::vector<io::SdfInclude>& includes) {
    for (const io::SdfInclude& include : includes) place(include);
    for (const auto& [model, count] : missing_) {
      const char* placeholder =
          is_vine(model) ? "a generated trellis row replaces it" : "it is left out";
      world_.notes.push_back(fmt::format("{}: model '{}' (included {} times) is missing; {}",
                                         params_.sdf_file.string(), model, count, placeholder));
    }
  }

  bool is_vine(const std::string& model) const {
    return !params_.vine_model.empty() && model.rfind(params_.vine_model, 0) == 0;
  }
  /// Pieces of vine rows have meshes: no replacement is needed.
  bool has_vine_meshes() const { return has_vine_meshes_; }
  const std::vector<MeshObject>& objects() const { return objects_; }
  /// First failed search: "model 'a' is in none of ..."; empty: all found.
  const std::string& first_miss() const { return first_miss_; }

 private:
  void place(const io::SdfInclude& include) {
    // Light, and Gazebo's built-in plane: `ground` makes one.
    if (include.model == "sun" || include.model == "ground_plane") return;
    if (include.written_out) {
      place(include, *include.written_out);
      return;
    }
    const std::filesystem::path sdf_folder = params_.sdf_file.parent_path();
    const auto folder = io::find_sdf_model(include, sdf_folder, folders_);
    if (folder) {
      place(include, io::read_sdf_model(*folder, folders_));
      return;
    }
    ++missing_[include.model];
    std::vector<std::string> looked_in;
    for (const auto& path : folders_) looked_in.push_back(path.lexically_normal().string());
    miss(include, fmt::format("model '{}' has no model.sdf in a folder '{}' of {}", include.model,
                              include.model, fmt::join(looked_in, " or ")));
  }

  void place(const io::SdfInclude& include, const io::SdfModel& model) {
    MeshObject object{world_.meshes.size(), world_.meshes.size()};
    for (const io::SdfMesh& mesh : model.meshes) {
      std::error_code error;
      if (!std::filesystem::is_regular_file(mesh.file, error)) {
        report_event(fmt::format("model '{}': mesh '{}' is missing", include.model, mesh.uri));
        miss(include, fmt::format("model '{}': mesh '{}' is not at '{}'", include.model, mesh.uri,
                                  mesh.file.lexically_normal().string()));
        continue;
      }
      io::MeshFileOptions options;
      options.scale = mesh.scale;
      options.up_axis = io::UpAxis::kAuto;
      object.end = library_
                       .place(include.name, mesh.file, options, include.X_WM * mesh.X_MG,
                              SurfaceClass::kObstacle, true, true,
                              "write <scale>0.001 0.001 0.001</scale> into its <mesh>")
                       .end;
    }
    std::vector<std::string> left_out = model.other_shapes;
    std::erase(left_out, "plane");  // `ground` lays one
    if (!left_out.empty()) {
      report_event(fmt::format("model '{}': {} left out, only meshes are read", include.model,
                               words_once(std::move(left_out))));
    }
    if (object.begin == object.end) return;
    objects_.push_back(object);
    has_vine_meshes_ = has_vine_meshes_ || is_vine(include.model);
  }

  void miss(const io::SdfInclude& include, const std::string& sentence) {
    if (!first_miss_.empty()) return;
    first_miss_ = fmt::format("{}:{}: {}", params_.sdf_file.string(), include.line, sentence);
  }
  void report_event(const std::string& note) {
    const auto known = std::find(world_.notes.begin(), world_.notes.end(), note);
    if (known == world_.notes.end()) world_.notes.push_back(note);
  }

  const MeshWorldParams& params_;
  std::vector<std::filesystem::path> folders_;
  MeshLibrary& library_;
  WorldModel& world_;
  std::map<std::string, int> missing_;
  std::vector<MeshObject> objects_;
  bool has_vine_meshes_ = false;
  std::string first_miss_;
};

/// Makes terrain of those objects without a given class that are the world's ground.
/// @returns true if there are any
bool mark_ground(const std::vector<MeshObject>& objects, WorldModel& world) {
  const std::vector<std::size_t> ground = find_ground(objects, world);
  for (const std::size_t i : ground) {
    for (std::size_t m = objects[i].begin; m < objects[i].end; ++m) {
      world.meshes[m].surface = SurfaceClass::kTerrain;
    }
  }
  if (!ground.empty()) {
    world.notes.push_back(
        fmt::format("mesh '{}' is under the whole world and is used as its ground, without a plane",
                    world.meshes[objects[ground.front()].begin].name));
  }
  return !ground.empty();
}

/// The box around every placed mesh and row, in the plane.
Eigen::AlignedBox2d extent_of(const WorldModel& world, const std::vector<mapping::RowCurve>& rows) {
  Eigen::AlignedBox2d box;
  for (const MeshInstance& instance : world.meshes) {
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      box.extend(Eigen::Vector2d((instance.X_WM * v.cast<double>()).head<2>()));
    }
  }
  for (const mapping::RowCurve& row : rows) {
    for (const Eigen::Vector2d& p : row.points_W()) box.extend(p);
  }
  if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
  return box;
}

void placeholder_plants(WorldModel& world, const std::vector<mapping::RowCurve>& rows,
                        const mapping::GroundHeight& ground, const MeshWorldParams& params) {
  const VinePlanting& planting = params.planting;
  const double spacing_m = params.vine_spacing_m;
  std::vector<VineRow> vine_rows;
  for (const mapping::RowCurve& row : rows) {
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
}

/// Plants the rows, unless their pieces have meshes, and adds them to the map.
void add_rows(WorldModel& world, const std::vector<mapping::RowCurve>& rows, bool have_meshes,
              const MeshWorldParams& params) {
  // The ground before plants are added, because their meshes reallocate the list.
  const WorldModel bare = world;
  std::optional<physics::WorldScene> scene;
  if (!bare.terrain) {
    physics::check_world(bare);
    scene.emplace(bare);
  }
  constexpr double kFromAbove_m = 1e4;
  const mapping::GroundHeight ground = [&](double x, double y) {
    if (!scene) return bare.terrain->height_m(x, y);
    return scene->ground_height_m(x, y, kFromAbove_m).value_or(0.0);
  };
  RowMap map = mapping::make_row_map(rows, ground, canopy_size(params.planting.canopy),
                                     mapping::parcel_boundary(rows, 8.0, 3.0));
  if (!have_meshes) check_pitch(params.planting, map);
  if (!have_meshes) placeholder_plants(world, rows, ground, params);
  world.rows = std::move(map);
  add_alley_spawn_points(world);
}

std::unique_ptr<WorldModel> make_mesh_world(const ParameterSet& parameters,
                                            const WorldContext& context) {
  MeshWorldParams params = mesh_world_table().read(parameters, "");
  params.planting = settle_growth(std::move(params.planting));
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
  std::vector<MeshObject> unnamed;  // without a given class
  for (const MeshItem& item : params.items) {
    const MeshObject object = place_item(item, library);
    has_ground = has_ground || item.surface == SurfaceClass::kTerrain;
    if (!item.surface && item.collides) unnamed.push_back(object);
  }
  std::vector<mapping::RowCurve> rows;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  SdfModels models(params, library, *world);
  if (!params.sdf_file.empty()) {
    const io::SdfWorld sdf = io::read_sdf_world(params.sdf_file, model_folders(params));
    const std::vector<io::SdfInclude>& includes = sdf.includes;
    models.place(includes);
    unnamed.insert(unnamed.end(), models.objects().begin(), models.objects().end());
    rows = find_sdf_rows(includes, params.vine_model, params.vine_piece_length_m);
    plane = fit_ground_plane(includes, params.vine_model);
    const bool states_none =
        params.origin.latitude_rad == 0.0 && params.origin.longitude_rad == 0.0;
    if (sdf.origin && states_none) {
      world->origin = {sdf.origin->latitude_rad, sdf.origin->longitude_rad, sdf.origin->altitude_m};
    }
  }
  if (world->meshes.empty() && rows.empty() && !models.first_miss().empty()) {
    throw ConfigError(fmt::format(
        "{}; the world has no mesh that could be loaded: put the files there or name their folders "
        "with model_folders",
        models.first_miss()));
  }
  if (!has_ground && params.ground != MeshGround::kFlat) {
    has_ground = mark_ground(unnamed, *world);
  }
  library.note_doubtful_units();

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
  if (!rows.empty()) add_rows(*world, rows, models.has_vine_meshes(), params);
  mapping::fill_occupancy(params.map, *world, {}, row_end_margin_m(params.planting));
  world->spawn_points.push_back({"centre", box.center(), 0.0});
  settle_shelter(*world);
  return world;
}

}  // namespace

void register_mesh(Registry& registry) {
  registry.add_world(mesh_spec(), make_mesh_world);
}

}  // namespace vinerow::worlds
