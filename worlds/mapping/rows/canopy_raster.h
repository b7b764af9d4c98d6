#pragma once
/// Canopy raster: counts of high points on a fine grid, seen from above.

#include <cstdint>
#include <vector>

#include "worlds/mapping/rows/cloud_terrain.h"

namespace vinerow::mapping {

/// Square (i, j) covers cell_m x cell_m from corner + cell_m (i, j), from the cloud's origin.
struct CanopyRaster {
  int columns = 0, rows = 0;
  double cell_m = 0.1;
  Eigen::Vector2d corner = {0, 0};
  std::vector<float>
      weights;  ///< 0: no canopy; 1: the average number of points of squares with canopy

  Eigen::Vector2d middle_of(int i, int j) const {
    return corner + cell_m * Eigen::Vector2d(i + 0.5, j + 0.5);
  }
  /// Index of the square that contains a point, or -1 outside.
  std::int64_t cell_of(double x, double y) const {
    const double u = (x - corner.x()) / cell_m, v = (y - corner.y()) / cell_m;
    if (!(u >= 0.0 && v >= 0.0 && u < columns && v < rows)) return -1;
    return static_cast<std::int64_t>(v) * columns + static_cast<std::int64_t>(u);
  }
};

/// Raster of the points from `low_m` to `high_m` above the ground. Weights are limited to 1, so
/// that a bush with many leaves counts no more than a vine.
/// @throws ConfigError if the bounds need more than 400 million squares
CanopyRaster make_canopy_raster(const ParcelCloud& cloud, const HeightAbove& height_above,
                                double cell_m, double low_m, double high_m);

/// Height above the ground that canopy reaches and weeds rarely do: three fifths of the median
/// height of the points above `cut_m`, clamped to `cut_m` to 1.1 m.
double body_height_m(const ParcelCloud& cloud, const HeightAbove& height_above, double cut_m,
                     double high_m);

/// The same raster with squares `factor` times as large, by means.
CanopyRaster coarsen(const CanopyRaster& raster, int factor);

}  // namespace vinerow::mapping
