#pragma once
/// Follows plant rows through the canopy raster, straight or curved, over missing vines.

#include <vector>

#include "worlds/mapping/cloud/rows/canopy_raster.h"
#include "worlds/mapping/cloud/rows/row_direction.h"

namespace vinerow::worlds {

struct RowTrackingOptions {
  double spacing_m = 2.5;        ///< between rows, about
  double longest_gap_m = 8.0;    ///< without canopy, on the way
  double longest_join_m = 25.0;  ///< between pieces of one row, where a row beside it goes on
};

/// Points of a row's middle from the cloud's origin, a metre apart, first and last on canopy.
using RowTrack = std::vector<Eigen::Vector2d>;

/// From the windows' rows (the window with most of them first) steps of 1 m go both ways, each to
/// the line through the canopy around it, until `longest_gap_m` without canopy or another row.
/// Pieces in one line are joined over a longer gap where a neighbour has none there: vines are
/// missing; where all rows end there is a track, and another block behind it.
std::vector<RowTrack> track_rows(const CanopyRaster& raster, const std::vector<RowPatch>& patches,
                                 const RowTrackingOptions& options);

}  // namespace vinerow::worlds
