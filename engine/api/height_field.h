#pragma once
/// Ground heights on a regular grid.

#include <Eigen/Core>
#include <vector>

namespace vinerow {

/// Regular grid of heights; x east, y north. Between samples the surface is two flat triangles per
/// cell, split along the diagonal from (i, j) to (i+1, j+1). Physics, rays and pictures use the
/// same triangles.
struct HeightField {
  int columns = 0;                    ///< samples along x, >= 2
  int rows = 0;                       ///< samples along y, >= 2
  double cell_m = 1.0;                ///< distance between samples
  Eigen::Vector2d corner_W = {0, 0};  ///< position of sample (0, 0)
  std::vector<float> heights_m;       ///< rows * columns, x fastest

  double width_m() const { return (columns - 1) * cell_m; }
  double depth_m() const { return (rows - 1) * cell_m; }
  bool contains(double x, double y) const {
    return x >= corner_W.x() && y >= corner_W.y() && x <= corner_W.x() + width_m() &&
           y <= corner_W.y() + depth_m();
  }
  /// Height of the triangle surface. Outside the grid the height of the nearest edge continues.
  double height_m(double x, double y) const;
  /// Upward unit normal of the triangle under (x, y); +z outside.
  Eigen::Vector3d normal_W(double x, double y) const;
};

}  // namespace vinerow
