#pragma once
/// The map `row_mesh`: the true rows with low-complexity row meshes, and what may be wrong with
/// them.
///
/// Source: paper A (Mammarella et al., Biosystems Engineering 223, 2022), section 3.2, and paper C
/// (Remote Sensing 14(6) 1374, 2022), section 2.2. Where paper A thins a point cloud, here the true canopy is measured
/// by rays and a chain of cross-sections is fitted to it (canopy_survey.h).

#include "engine/api/registry.h"
#include "worlds/mapping/from_truth/mesh_accuracy.h"
#include "worlds/mapping/from_truth/row_mesh_parameters.h"

namespace vinerow::mapping {

/// What was made of what.
struct RowMeshReport {
  std::int64_t triangles = 0;
  std::int64_t true_triangles = 0;  ///< of the canopy's hulls
  std::vector<int> unseen_rows;     ///< without canopy: from the row's own width, base and top
  MeshAccuracy accuracy;            ///< before the map is shifted, turned and scaled
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< offset_m and what was drawn
  std::vector<MissingStretch> missing;                ///< asked for and drawn
};

/// @param report  filled if not null
/// @throws ConfigError where the world has no rows, a row that is named is not there, or a folder
/// holds no meshes
std::unique_ptr<RowMap> make_row_mesh_map(const ParameterSet& parameters, const MapContext& context,
                                          RowMeshReport* report = nullptr);

void register_row_mesh_map(Registry& registry);

}  // namespace vinerow::mapping
