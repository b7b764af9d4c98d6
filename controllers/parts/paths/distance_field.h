#pragma once
/// Distance of every point of an occupancy grid from the nearest occupied cell.
///
/// Exact Euclidean distance transform in two passes of lower envelopes of parabolas (Felzenszwalb,
/// Huttenlocher, "Distance Transforms of Sampled Functions", Theory of Computing 8, 2012): linear
/// in the number of cells. Values are distances to the edge of occupied cells: half a cell less
/// than between cell centres.

#include <Eigen/Core>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::controllers {

class DistanceField {
 public:
  /// An empty field: infinite distance everywhere.
  DistanceField() = default;
  /// @param grid  copied from; an empty grid gives an empty field
  explicit DistanceField(const OccupancyGrid& grid);

  bool empty() const { return columns_ == 0; }
  double cell_m() const { return cell_m_; }
  /// Lower left corner of the grid.
  const Eigen::Vector2d& corner_W() const { return corner_W_; }
  /// Extents along x and y; zero if empty.
  Eigen::Vector2d size_m() const { return cell_m_ * Eigen::Vector2d(columns_, rows_); }
  /// Distance at a point, m, bilinear between cell centres, >= 0. Outside the grid it is 0:
  /// unmapped ground counts as occupied. An empty field returns infinity. No heap; about 10 ns.
  double at(const Eigen::Vector2d& p_W) const;
  /// True if the point is on the grid.
  bool covers(const Eigen::Vector2d& p_W) const;

 private:
  void square_along_row(const OccupancyGrid& grid, int j);

  int columns_ = 0;
  int rows_ = 0;
  double cell_m_ = 1.0;
  Eigen::Vector2d corner_W_ = {0, 0};
  std::vector<float> distance_m_;  // of cell centres, x fastest
};

}  // namespace vinerow::controllers
