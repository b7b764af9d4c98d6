#pragma once
/// How far a map's row meshes are from the true canopy.

#include <cstdint>

#include "engine/api/map.h"
#include "engine/api/scene_query.h"

namespace vinerow::mapping {

/// Of points spread evenly over facets, along the facets' outward normals to the canopy; facets
/// that look along the row are left out.
struct MeshAccuracy {
  double rms_m = 0.0;
  double mean_m = 0.0;                ///< > 0: the canopy lies outside the map
  double correlation_length_m = 0.0;  ///< along the row, until 1/e of the mean square is left
  std::int64_t points = 0;
  std::int64_t far_points = 0;  ///< with no canopy within 0.4 m: gaps; they count nowhere else
};

/// @param rows  lines of the rows that the meshes belong to
/// @param wanted_points  about so many; fewer on small maps
MeshAccuracy measure_accuracy(const SceneQuery& scene, const std::vector<PlantRow>& rows,
                              const std::vector<RowMesh>& meshes,
                              std::int64_t wanted_points = 100'000);

}  // namespace vinerow::mapping
