#pragma once
/// Parameters of the world `mesh`.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/io/meshes/mesh_file.h"
#include "engine/math/pose.h"
#include "worlds/mapping/from_truth/map_parameters.h"
#include "worlds/parts/common.h"
#include "worlds/parts/terrain.h"
#include "worlds/plants/vine_rows.h"

namespace vinerow::worlds {

/// Mesh file with its pose.
struct MeshItem {
  std::filesystem::path file;
  std::string name;  ///< empty: the file's name
  Eigen::Vector3d p_WM = {0.0, 0.0, 0.0};
  RollPitchYaw rpy;
  double scale = 1.0;
  io::UpAxis up_axis = io::UpAxis::kAuto;
  std::optional<double> unit_m;
  /// Absent: terrain if it is below the whole world (ground_meshes.h), else an obstacle.
  std::optional<SurfaceClass> surface;
  std::optional<Label> label;  ///< for cameras; absent: by the surface
  std::optional<double> leaf_area_density_m2pm3;  ///< of canopy
  bool collides = true;
  bool visible = true;
};

enum class MeshGround {
  kAuto,  ///< flat if no mesh is terrain
  kNone,
  kFlat
};

struct MeshWorldParams {
  std::vector<MeshItem> items;
  std::filesystem::path sdf_file;
  std::vector<std::string> model_folders;  ///< empty: ../models of sdf_file
  std::string vine_model = "vine";         ///< prefix of the models that are pieces of vine rows
  double vine_piece_length_m = 6.0;        ///< along its x axis
  MeshGround ground = MeshGround::kAuto;
  double ground_margin_m = 8.0;
  double vine_spacing_m = 1.0;  ///< of a placeholder row
  TerrainParams terrain;
  VinePlanting planting;
  GeoOrigin origin;  ///< latitude and longitude 0: the SDF world's, if it has one
  Surroundings surroundings;
  mapping::MapParams map;
};

const ParameterTable<MeshWorldParams>& mesh_world_table();

}  // namespace vinerow::worlds
