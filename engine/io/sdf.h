#pragma once
/// SDF worlds (Gazebo): which models are included, and where they stand.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/pose.h"

namespace vinerow::io {

/// One <include> of a world.
struct SdfInclude {
  std::string uri;    ///< "model://vine_t1"
  std::string model;  ///< "vine_t1"
  std::string name;   ///< <name>, or the model's with a number
  Pose X_WM;          ///< <pose>: x y z roll pitch yaw, m and rad; identity where absent
  int line = 0;       ///< in the file
};

/// A mesh of a model's visual (or collision where it has no visual).
struct SdfMesh {
  std::string uri;             ///< as written
  std::filesystem::path file;  ///< where it should be
  Pose X_MG;                   ///< in the model: link pose times visual pose
  Eigen::Vector3d scale = {1, 1, 1};
};

/// @throws ConfigError naming the file (and line): missing, malformed XML, no <sdf><world>, a
/// <pose> that is not six
///         finite numbers
std::vector<SdfInclude> read_sdf_includes(const std::filesystem::path& file);

/// The folder of a model: `<folder>/<model>` in one of the search folders, with a model.sdf.
std::optional<std::filesystem::path> find_sdf_model(
    const std::string& model, const std::vector<std::filesystem::path>& search_folders);

/// Meshes of a model.sdf. `model://<anything>/meshes/x.dae` is looked for in the model's own
/// folder, because copies of models are often renamed. @throws ConfigError as above
std::vector<SdfMesh> read_sdf_meshes(const std::filesystem::path& model_folder);

}  // namespace vinerow::io
