#pragma once
/// Fast lookup of the plant row that a point belongs to.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// Position relative to a row.
struct RowPlace {
  int row = -1;  ///< index of the line; -1: no row within reach
  float s_m = 0.0f, y_m = 0.0f;
};

/// Grid with the nearest row, and the stretch of it, for every square.
class RowLocator {
 public:
  /// @param lines    in any frame
  /// @param reach_m  largest distance from a line at which points belong to it
  RowLocator(const std::vector<RowCurve>& lines, double reach_m);
  /// @param reach_m  of each line
  RowLocator(const std::vector<RowCurve>& lines, const std::vector<double>& reach_m);

  /// Arc length (below 0 or above the length beyond the ends) and offset to the left of the nearest
  /// row. Points within `reach_m` across and 1 m along a row are found.
  RowPlace locate(double x, double y) const;

 private:
  struct Square {
    std::int16_t row = -1;
    std::int16_t segment = 0;
  };
  std::vector<RowCurve> lines_;
  std::vector<double> reach_m_;  // of each line
  std::vector<Square> squares_;
  Eigen::Vector2d corner_ = {0, 0};
  int columns_ = 0, rows_ = 0;
};

}  // namespace vinerow::mapping
