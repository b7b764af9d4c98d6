#pragma once
/// Accuracy of a map's row meshes against the true canopy.

#include <cstdint>

#include "engine/api/map.h"
#include "engine/api/scene_query.h"

namespace vinerow::mapping {

/// Distances to the canopy along the facets' outward normals, at points spread evenly over the
/// facets. Facets whose normal is along the row are left out.
struct MeshAccuracy {
  double rms_m = 0.0;
  double mean_m = 0.0;                ///< > 0: the canopy is outside the map's meshes
  double correlation_length_m = 0.0;  ///< along the row, until 1/e of the mean square is left
  std::int64_t points = 0;
  std::int64_t far_points = 0;  ///< without canopy within 0.4 m (gaps); in no other figure
};

/// @param rows  lines of the rows that the meshes belong to
/// @param wanted_points  approximate number of points; fewer on small maps
MeshAccuracy measure_accuracy(const SceneQuery& scene, const std::vector<PlantRow>& rows,
                              const std::vector<RowMesh>& meshes,
                              std::int64_t wanted_points = 100'000);

}  // namespace vinerow::mapping
