#pragma once
/// Where canopy stands, seen from above: counts of high points on a fine grid.

#include <cstdint>
#include <vector>

#include "worlds/mapping/rows/cloud_terrain.h"

namespace vinerow::mapping {

/// Square (i, j) covers cell_m x cell_m from corner + cell_m (i, j), from the cloud's origin.
struct CanopyRaster {
  int columns = 0, rows = 0;
  double cell_m = 0.1;
  Eigen::Vector2d corner = {0, 0};
  std::vector<float> weights;  ///< 0: no canopy; 1: as many points as squares hold on the average

  Eigen::Vector2d middle_of(int i, int j) const {
    return corner + cell_m * Eigen::Vector2d(i + 0.5, j + 0.5);
  }
  /// Index of the square that a point lies in, or -1 outside.
  std::int64_t cell_of(double x, double y) const {
    const double u = (x - corner.x()) / cell_m, v = (y - corner.y()) / cell_m;
    if (!(u >= 0.0 && v >= 0.0 && u < columns && v < rows)) return -1;
    return static_cast<std::int64_t>(v) * columns + static_cast<std::int64_t>(u);
  }
};

/// Of points from `low_m` to `high_m` above the ground. Squares with many points count no more
/// than 1, so that a bush with many leaves is worth no more than a vine.
/// @throws ConfigError where the bounds need more than 400 million squares
CanopyRaster make_canopy_raster(const ParcelCloud& cloud, const HeightAbove& height_above,
                                double cell_m, double low_m, double high_m);

/// Height above the ground that canopy reaches and weeds hardly do: three fifths of the middle
/// height of what is higher than `cut_m`, from `cut_m` to 1.1 m.
double body_height_m(const ParcelCloud& cloud, const HeightAbove& height_above, double cut_m,
                     double high_m);

/// The same with squares `factor` times as large: means.
CanopyRaster coarsen(const CanopyRaster& raster, int factor);

}  // namespace vinerow::mapping
