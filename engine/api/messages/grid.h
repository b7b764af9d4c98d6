#pragma once
/// The message that says where on the ground something stands.
/// Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace vinerow {

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

}  // namespace vinerow
