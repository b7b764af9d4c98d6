#pragma once
/// SDF worlds (Gazebo): which models there are, where they stand, and where on Earth.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/pose.h"

namespace vinerow::io {

/// A mesh of a model's visual (or collision where it has no visual).
struct SdfMesh {
  std::string uri;             ///< as written
  std::filesystem::path file;  ///< where it is, or should be
  Pose X_MG;                   ///< in the model: link pose times visual pose
  Eigen::Vector3d scale = {1, 1, 1};
};

/// What a model consists of.
struct SdfModel {
  std::vector<SdfMesh> meshes;
  std::vector<std::string> other_shapes;  ///< elements that are no mesh: "box", "plane", ...
};

/// A model placed in a world: an <include>, or a <model> that is written out there.
struct SdfInclude {
  std::string uri;    ///< "model://vine_t1"; empty where the model is written out
  std::string model;  ///< "vine_t1"
  std::string name;   ///< <name>, or the model's with a number
  Pose X_WM;          ///< in east, north, up; as saved in <state>, else <pose>, else identity
  int line = 0;       ///< in the file
  std::optional<SdfModel> written_out;
};

/// <spherical_coordinates>
struct SdfOrigin {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;
  double heading_rad = 0.0;  ///< of the file's x axis from east, counter-clockwise
};

struct SdfWorld {
  std::vector<SdfInclude> includes;  ///< in the order of the file
  /// Absent where the file says none, or latitude and longitude 0, which stands for none.
  std::optional<SdfOrigin> origin;
};

/// URIs of meshes: `model://name/meshes/x.dae` is looked for in the folder of the file that names
/// it (copies of models are often renamed), then as `name/meshes/x.dae` in the search folders; a
/// path without a scheme, or `file://`, is absolute or beside that file.
/// @throws ConfigError naming the file (and line): missing, malformed XML, no <sdf><world>, a
/// <pose> that is not six finite numbers, a place that is not on Earth
SdfWorld read_sdf_world(const std::filesystem::path& file,
                        const std::vector<std::filesystem::path>& search_folders);

/// The folder of an included model, which holds its model.sdf: where a URI that is a path points
/// to, or `<folder>/<model>` in one of the search folders.
std::optional<std::filesystem::path> find_sdf_model(
    const SdfInclude& include, const std::filesystem::path& world_folder,
    const std::vector<std::filesystem::path>& search_folders);

/// A folder's model.sdf. @throws ConfigError as above
SdfModel read_sdf_model(const std::filesystem::path& model_folder,
                        const std::vector<std::filesystem::path>& search_folders);

}  // namespace vinerow::io
