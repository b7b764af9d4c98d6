#pragma once
/// Occupancy grid message. Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "engine/api/field.h"

namespace vinerow {

/// Occupied cells of the ground: 1 occupied by an obstacle, 0 free. Cell (i, j) has its lower left
/// corner at corner_W + cell_m * (i, j). Paper A, section 3.1; made by worlds/mapping. ROS 2:
/// nav_msgs/msg/OccupancyGrid.
struct OccupancyGrid {
  static constexpr const char* kType = "OccupancyGrid";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  int columns = 0;  ///< along x; 0: there is no grid
  int rows = 0;     ///< along y
  double cell_m = 1.0;
  Eigen::Vector2d corner_W = {0, 0};
  std::vector<std::uint8_t> cells;  ///< rows * columns, x fastest

  bool occupied(int i, int j) const {
    return cells[static_cast<std::size_t>(j) * columns + i] != 0;
  }
  bool empty() const { return columns == 0 || rows == 0; }
  /// True if the number of cells matches rows and columns; data from files may be damaged.
  bool valid() const {
    return columns >= 0 && rows >= 0 &&
           static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) == cells.size();
  }

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"columns"}, self.columns);
    f({"rows"}, self.rows);
    f({"cell", "m"}, self.cell_m);
    f({"corner_x", "m", "lower left corner of the first cell"}, self.corner_W.x());
    f({"corner_y", "m"}, self.corner_W.y());
    f({"cells", "", "1 occupied, 0 free; x fastest"}, self.cells);
  }
};

}  // namespace vinerow
