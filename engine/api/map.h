#pragma once
/// Plain data about a vineyard, shared by the true world and by the maps that vehicles are told.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

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

/// What guidance and estimators know of the world.
struct RowMap {
  std::vector<PlantRow> rows;
  std::vector<Alley> alleys;                ///< in driving order across the block
  std::vector<Eigen::Vector2d> boundary_W;  ///< parcel polygon, counter-clockwise, or empty
  OccupancyGrid occupancy;                  ///< empty where the world has none
};

}  // namespace vinerow
