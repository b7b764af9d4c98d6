#pragma once
/// Plain data about a vineyard, shared by the true world and by the maps that vehicles are told.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"

namespace vinerow {

/// A plant row: its centre line at ground level and the canopy's cross-section.
struct PlantRow {
  int id = 0;
  std::vector<Eigen::Vector3d> line_W;  ///< >= 2 points, m, from one end to the other
  double canopy_width_m = 0.6;
  double canopy_base_m = 0.5;  ///< lowest leaves above ground
  double canopy_top_m = 2.0;
};

/// The free strip between two neighbouring rows (or beside the first and last), with its centre
/// line.
struct Alley {
  int id = 0;
  std::vector<Eigen::Vector3d> line_W;  ///< >= 2 points, m
  double width_m = 2.5;                 ///< between the rows' centre lines
};

/// Which squares of the ground are taken: 1 by an obstacle, 0 free. Square (i, j) covers the cell
/// whose lower left corner is corner_W + cell_m * (i, j). Paper A, section 3.1; made by
/// worlds/mapping. ROS 2: nav_msgs/msg/OccupancyGrid.
struct OccupancyGrid {
  static constexpr const char* kType = "OccupancyGrid";
  int columns = 0;  ///< along x; 0: there is no grid
  int rows = 0;     ///< along y
  double cell_m = 1.0;
  Eigen::Vector2d corner_W = {0, 0};
  std::vector<std::uint8_t> cells;  ///< rows * columns, x fastest

  bool occupied(int i, int j) const {
    return cells[static_cast<std::size_t>(j) * columns + i] != 0;
  }
  bool empty() const { return columns == 0 || rows == 0; }

  template <class F>
  void fields(F&& f) {
    f(columns), f(rows), f(cell_m), f(corner_W.x()), f(corner_W.y()), f(cells);
  }
};

/// A row's canopy on the low-complexity 3D map: a closed hull of few triangles in W. Papers A,
/// section 3.2, and C, section 2.2.
struct RowMesh {
  int row = 0;  ///< PlantRow::id
  TriangleMesh mesh_W;
};

/// What a map's maker states about the distance from its row meshes to the true canopy.
struct MapAccuracy {
  double surface_std_m = 0.03;        ///< 1 sigma along the meshes' normals
  double correlation_length_m = 0.3;  ///< along the row, over which such an error stays
  Eigen::Vector3d offset_std_m =
      Eigen::Vector3d::Zero();  ///< 1 sigma of a shift of the whole map, east, north, up
};

/// What planners, guidance and estimators know of the world.
struct RowMap {
  std::vector<PlantRow> rows;
  std::vector<Alley> alleys;                ///< in driving order across the block
  std::vector<Eigen::Vector2d> boundary_W;  ///< parcel polygon, counter-clockwise, or empty
  OccupancyGrid occupancy;                  ///< empty where the world has none
  std::vector<RowMesh> meshes;              ///< empty where the map has none
  MapAccuracy accuracy;                     ///< of the meshes
  std::optional<HeightField> terrain;       ///< absent where the map takes the world's ground
};

}  // namespace vinerow
