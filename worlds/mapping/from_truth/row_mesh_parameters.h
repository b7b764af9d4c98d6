#pragma once
/// Parameters of the map `row_mesh`.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "worlds/mapping/from_truth/canopy_survey.h"

namespace vinerow::mapping {

/// Gap in the map, along the row's line; the true row may have vines there.
struct MissingStretch {
  int row = 0;
  double from_m = 0.0, to_m = 0.0;
};

/// Such gaps at random places.
struct RandomMissing {
  int count = 0;
  double length_m = 1.0;  ///< of each gap
};

struct RowMeshParams {
  CanopySurveyOptions sections;
  std::string survey;                                  ///< vehicles that name one share its map
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< east, north, up; not stated by the map
  Eigen::Vector3d offset_std_m =
      Eigen::Vector3d::Zero();  ///< of a further shift; the map states it
  double scale = 1.0;           ///< about the middle of the rows
  double rotation_rad = 0.0;    ///< likewise, counter-clockwise
  bool move_rows = true;        ///< with the meshes
  double surface_noise_std_m = 0.0;
  double surface_noise_length_m = 0.3;
  std::vector<MissingStretch> missing;
  std::optional<RandomMissing> random_missing;
  bool fill_gaps = false;
  double stated_surface_std_m = 0.0;         ///< 0: as measured
  double stated_correlation_length_m = 0.0;  ///< 0: as measured
  std::filesystem::path folder;              ///< of meshes instead of a survey, or empty
  std::string save_to;                       ///< folder, or empty
};

const ParameterTable<RowMeshParams>& row_mesh_table();

/// Rejects options that need a survey if a folder of meshes is given. @throws ConfigError naming
/// the option
void check_folder_parameters(const RowMeshParams& params);

}  // namespace vinerow::mapping
