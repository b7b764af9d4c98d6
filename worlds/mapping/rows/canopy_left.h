#pragma once
/// Canopy of the raster that belongs to no row; a map reports it as left out.

#include <vector>

#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/row_locator.h"

namespace vinerow::mapping {

/// Piece of canopy, connected over squares of 2 m.
struct CanopyLeft {
  double area_m2 = 0.0;
  Eigen::Vector2d low = {0, 0}, high = {0, 0};  ///< of its bounding box, from the cloud's origin

  Eigen::Vector2d middle() const { return 0.5 * (low + high); }
};

/// Pieces, the largest first; those below `min_m2` are left out.
std::vector<CanopyLeft> find_canopy_left(const CanopyRaster& raster, const RowLocator& rows,
                                         double min_m2);

}  // namespace vinerow::mapping
