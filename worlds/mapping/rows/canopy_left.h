#pragma once
/// Canopy of the raster that no row was found on: what a map must say that it leaves out.

#include <vector>

#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/row_locator.h"

namespace vinerow::mapping {

/// One piece, as it hangs together over squares of 2 m.
struct CanopyLeft {
  double area_m2 = 0.0;
  Eigen::Vector2d low = {0, 0}, high = {0, 0};  ///< of the box around it, from the cloud's origin

  Eigen::Vector2d middle() const { return 0.5 * (low + high); }
};

/// The largest first; pieces below `least_m2` are left out.
std::vector<CanopyLeft> find_canopy_left(const CanopyRaster& raster, const RowLocator& rows,
                                         double least_m2);

}  // namespace vinerow::mapping
