#pragma once
/// Follows plant rows through the canopy raster, straight or curved, over missing vines.

#include <vector>

#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/row_direction.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

struct RowTrackingOptions {
  double spacing_m = 2.5;        ///< between rows, about
  double open_gap_m = 3.0;       ///< without canopy on the way, nor in a row beside it: a machine
                                 ///< that turns at the rows' ends needs more
  double longest_gap_m = 8.0;    ///< the same where a row beside it goes on
  double longest_join_m = 25.0;  ///< between pieces of one row, where a row beside it goes on
};

/// Points of a row's middle from the cloud's origin, a metre apart, first and last on canopy.
using RowTrack = std::vector<Eigen::Vector2d>;

/// Which squares of a raster rows already run through: nothing else starts or goes there.
using TakenSquares = std::vector<std::uint8_t>;

/// From the windows' rows (the window with most of them first) steps of 1 m go both ways, each to
/// the line through the canopy around it, until another row, or a gap that is too long.
/// Pieces in one line are joined over a longer gap where a row beside it has none there: vines are
/// missing; where all rows end there is a track, and another block behind it.
/// @param taken  empty, or squares of rows that are known
std::vector<RowTrack> track_rows(const CanopyRaster& raster, const std::vector<RowPatch>& patches,
                                 const RowTrackingOptions& options, const TakenSquares& taken = {});

/// Adds the squares of rows to those taken. @param taken  empty, or of the raster
void take_rows(const CanopyRaster& raster, const std::vector<RowCurve>& rows, double spacing_m,
               TakenSquares& taken);

}  // namespace vinerow::mapping
