#pragma once
/// Map `row_mesh`: the true rows with low-complexity row meshes and optional errors.
///
/// Source: paper A (Mammarella et al., Biosystems Engineering 223, 2022), section 3.2, and paper C
/// (Remote Sensing 14(6) 1374, 2022), section 2.2. Paper A reduces a point cloud; here rays measure
/// the true canopy, and a chain of cross-sections is fitted to it (canopy_survey.h).

#include "engine/api/registry.h"
#include "worlds/mapping/from_truth/mesh_accuracy.h"
#include "worlds/mapping/from_truth/row_mesh_parameters.h"

namespace vinerow::mapping {

/// Report on the making of a map.
struct RowMeshReport {
  std::int64_t triangles = 0;
  std::int64_t true_triangles = 0;  ///< of the canopy's hulls
  std::vector<int> unseen_rows;     ///< without canopy: from the row's own width, base and top
  MeshAccuracy accuracy;            ///< before the map is shifted, rotated and scaled
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< offset_m and the drawn shift
  std::vector<MissingStretch> missing;                ///< listed and drawn
};

/// @param report  filled if not null
/// @throws ConfigError if the world has no rows, a named row does not exist, or a folder contains
/// no meshes
std::unique_ptr<RowMap> make_row_mesh_map(const ParameterSet& parameters, const MapContext& context,
                                          RowMeshReport* report = nullptr);

void register_row_mesh_map(Registry& registry);

}  // namespace vinerow::mapping
