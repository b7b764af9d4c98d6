#pragma once
/// Lookup of plant rows by position, for pictures.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/api/plant_row.h"

namespace vinerow::tools {

/// Grid over the block with the index of the nearest row in each cell.
class RowLookup {
 public:
  /// @param reach_m  maximum distance from a row's line
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
