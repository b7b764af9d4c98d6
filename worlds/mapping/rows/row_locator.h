#pragma once
/// Finds the plant row that a place belongs to, many millions of times.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// A place seen from a row.
struct RowPlace {
  int row = -1;  ///< index of the line; -1: no row within reach
  float s_m = 0.0f, y_m = 0.0f;
};

/// A grid that knows the nearest row and the stretch of it for every square.
class RowLocator {
 public:
  /// @param lines    in any frame
  /// @param reach_m  how far from a line places belong to it
  RowLocator(const std::vector<RowCurve>& lines, double reach_m);
  /// @param reach_m  of each line
  RowLocator(const std::vector<RowCurve>& lines, const std::vector<double>& reach_m);

  /// Arc length (below 0 and beyond the length behind the ends) and offset to the left of the
  /// nearest row. Places within `reach_m` across and 1 m along of a row are found.
  RowPlace locate(double x, double y) const;

 private:
  struct Line {
    std::vector<Eigen::Vector2d> points, directions;
    std::vector<double> s_m;
    double reach_m = 0.0;
  };
  struct Square {
    std::int16_t row = -1;
    std::int16_t segment = 0;
  };
  std::vector<Line> lines_;
  std::vector<Square> squares_;
  Eigen::Vector2d corner_ = {0, 0};
  int columns_ = 0, rows_ = 0;
};

}  // namespace vinerow::mapping
