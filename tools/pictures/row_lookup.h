#pragma once
/// Which plant row stands at a place, for pictures.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/api/plant_row.h"

namespace vinerow::tools {

/// Index of the nearest row for every square of a grid over the block.
class RowLookup {
 public:
  /// @param reach_m  farther from every row's line there is none
  RowLookup(const std::vector<PlantRow>& rows, double reach_m);
  /// Index into the rows, or -1.
  int row_at(double x, double y) const;

 private:
  double cell_m_ = 0.2;
  Eigen::Vector2d corner_W_ = {0, 0};
  int columns_ = 0, rows_ = 0;
  std::vector<std::int16_t> nearest_;
};

}  // namespace vinerow::tools
