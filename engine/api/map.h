#pragma once
/// Plain data about a vineyard, shared by the true world and by the vehicles' maps.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/api/messages/grid.h"
#include "engine/api/plant_row.h"

namespace vinerow {

/// Canopy of a row on the low-complexity 3D map: a closed hull of few triangles in W. Papers A,
/// section 3.2, and C, section 2.2.
struct RowMesh {
  int row = 0;  ///< PlantRow::id
  TriangleMesh mesh_W;
};

/// Stated accuracy of a map: distance from its row meshes to the true canopy.
struct MapAccuracy {
  double surface_std_m = 0.03;        ///< 1 sigma along the meshes' normals
  double correlation_length_m = 0.3;  ///< along the row, distance over which such an error persists
  Eigen::Vector3d offset_std_m =
      Eigen::Vector3d::Zero();  ///< 1 sigma of a shift of the whole map, east, north, up
};

/// What planners, guidance and estimators know about the world.
struct RowMap {
  std::vector<PlantRow> rows;
  std::vector<Alley> alleys;                ///< in driving order across the block
  std::vector<Eigen::Vector2d> boundary_W;  ///< parcel polygon, counter-clockwise, or empty
  OccupancyGrid occupancy;                  ///< empty if the world has no grid
  std::vector<RowMesh> meshes;              ///< empty if the map has no meshes
  MapAccuracy accuracy;                     ///< of the meshes
  std::optional<HeightField> terrain;       ///< absent if the map uses the world's ground
};

}  // namespace vinerow
