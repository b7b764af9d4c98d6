#pragma once
/// Tracking of plant rows, straight or curved, through the canopy raster and across missing vines.

#include <vector>

#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/row_direction.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

struct RowTrackingOptions {
  double spacing_m = 2.5;        ///< approximate distance between rows
  double open_gap_m = 3.0;       ///< longest gap in a row if its neighbours have it too: a
                                 ///< headland, in which machines turn, is wider
  double longest_gap_m = 8.0;    ///< longest gap if a neighbour goes on beside it
  double longest_join_m = 25.0;  ///< longest gap between pieces of one row that are joined
};

/// Points on a row's middle relative to the cloud's origin, 1 m apart, the first and last on
/// canopy.
using RowTrack = std::vector<Eigen::Vector2d>;

/// For each square of a raster, 1 if a row already runs through it; tracks neither start nor
/// continue there.
using TakenSquares = std::vector<std::uint8_t>;

/// Tracks of all rows, from seeds in the windows.
///
/// The window with the most canopy that is likely to be rows comes first. From each seed the track
/// goes both ways in steps of 1 m, each onto the line through the canopy around it, until it meets
/// another row or too long a gap. Pieces in one line are joined across a longer gap if a
/// neighbouring row has no gap there (vines are missing). If all rows end there, the gap is a track
/// between two blocks.
/// @param taken  empty, or squares of rows that are known
std::vector<RowTrack> track_rows(const CanopyRaster& raster, const std::vector<RowPatch>& patches,
                                 const RowTrackingOptions& options, const TakenSquares& taken = {});

/// Marks the squares of rows as taken. @param taken  empty, or as large as the raster
void take_rows(const CanopyRaster& raster, const std::vector<RowCurve>& rows, double spacing_m,
               TakenSquares& taken);

}  // namespace vinerow::mapping
