#pragma once
/// Reader of SDF worlds (Gazebo): models, their poses, and the position on Earth.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/pose.h"

namespace vinerow::io {

/// Mesh of a model's visual, or of its collision if it has no visual.
struct SdfMesh {
  std::string uri;             ///< as written
  std::filesystem::path file;  ///< resolved path; the file may be missing
  Pose X_MG;                   ///< pose in the model: link pose times visual pose
  Eigen::Vector3d scale = {1, 1, 1};
};

/// Contents of a model.
struct SdfModel {
  std::vector<SdfMesh> meshes;
  std::vector<std::string> other_shapes;  ///< elements other than meshes: "box", "plane", ...
};

/// A model placed in a world: an <include>, or an inline <model>.
struct SdfInclude {
  std::string uri;    ///< "model://vine_t1"; empty for an inline model
  std::string model;  ///< "vine_t1"
  std::string name;   ///< <name>, or the model's with a number
  Pose X_WM;          ///< in east, north, up; from <state>, else <pose>, else identity
  int line = 0;       ///< in the file
  std::optional<SdfModel> written_out;
};

/// Contents of <spherical_coordinates>.
struct SdfOrigin {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;
  double heading_rad = 0.0;  ///< of the file's x axis from east, counter-clockwise
};

struct SdfWorld {
  std::vector<SdfInclude> includes;  ///< in the order of the file
  /// Absent if the file has no origin, or latitude and longitude are both 0.
  std::optional<SdfOrigin> origin;
};

/// Reads a world. Mesh URIs `model://name/meshes/x.dae` are searched in the folder of the file that
/// names them (copies of models are often renamed), then as `name/meshes/x.dae` in the search
/// folders. Paths without a scheme, or with `file://`, are absolute or relative to the folder of
/// that file.
/// @throws ConfigError naming the file (and line): missing, malformed XML, no <sdf><world>, a
/// <pose> that is not six finite numbers, invalid latitude or longitude
SdfWorld read_sdf_world(const std::filesystem::path& file,
                        const std::vector<std::filesystem::path>& search_folders);

/// Folder of an included model, with its model.sdf: the path in the URI, or `<folder>/<model>` for
/// one of the search folders.
std::optional<std::filesystem::path> find_sdf_model(
    const SdfInclude& include, const std::filesystem::path& world_folder,
    const std::vector<std::filesystem::path>& search_folders);

/// Reads a folder's model.sdf. @throws ConfigError as above
SdfModel read_sdf_model(const std::filesystem::path& model_folder,
                        const std::vector<std::filesystem::path>& search_folders);

}  // namespace vinerow::io
