#pragma once
/// Canopy rasters painted from known lines: every square whose middle is on a strip has weight 1.

#include <vector>

#include "worlds/mapping/model/row_curve.h"
#include "worlds/mapping/rows/canopy_raster.h"

namespace vinerow::test {

/// Empty raster of squares of 0.1 m from (0, 0).
inline mapping::CanopyRaster empty_raster(double width_m, double depth_m) {
  mapping::CanopyRaster raster;
  raster.columns = static_cast<int>(std::lround(10.0 * width_m));
  raster.rows = static_cast<int>(std::lround(10.0 * depth_m));
  raster.weights.assign(static_cast<std::size_t>(raster.columns) * raster.rows, 0.0f);
  return raster;
}

/// Paints the squares for which is_canopy(x, y) is true.
template <class F>
void paint(mapping::CanopyRaster& raster, F&& is_canopy) {
  for (int j = 0; j < raster.rows; ++j) {
    for (int i = 0; i < raster.columns; ++i) {
      const Eigen::Vector2d p = raster.middle_of(i, j);
      if (is_canopy(p.x(), p.y())) {
        raster.weights[static_cast<std::size_t>(j) * raster.columns + i] = 1.0f;
      }
    }
  }
}

/// Paints a box along the axes.
inline void paint_box(mapping::CanopyRaster& raster, double from_x, double to_x, double from_y,
                      double to_y) {
  paint(raster,
        [&](double x, double y) { return x > from_x && x < to_x && y > from_y && y < to_y; });
}

/// Strip of 0.6 m along x.
inline void paint_row(mapping::CanopyRaster& raster, double from_x, double to_x, double y) {
  paint_box(raster, from_x, to_x, y - 0.3, y + 0.3);
}

}  // namespace vinerow::test
