#pragma once
/// Tracking of plant rows, straight or curved, through the canopy raster and across missing vines.

#include <vector>

#include "worlds/mapping/model/row_curve.h"
#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/row_direction.h"

namespace vinerow::mapping {

struct RowTrackingOptions {
  double spacing_m = 2.5;        ///< approximate distance between rows
  double open_gap_m = 3.0;       ///< longest gap in a row if its neighbours have it too: a
                                 ///< headland, in which machines turn, is wider
  double longest_gap_m = 8.0;    ///< longest gap if a neighbour goes on beside it
  double longest_join_m = 25.0;  ///< longest gap between pieces of one row that are joined

  // Thresholds, all chosen.
  /// Half width of a row, of the spacing: below 0.5, so that neighbouring rows do not overlap.
  double row_reach = 0.4;
  double max_turn = 0.1;  ///< of a step, about 6 degrees: a radius of 10 m
  double along_m = 3.0;   ///< seven steps: two missing vines leave canopy on both sides
  double sigma = 0.5;     ///< of the reach: canopy off the middle counts less, at the reach 0.14
  /// Weight of the place against the direction: less, so that a track returns to the middle.
  double centre_hold = 0.3;
  double support = 0.2;        ///< canopy of a step over that of a full row
  double max_side_step = 0.2;  ///< of the step's length
  double beside = 0.5;         ///< share of a gap beside which a neighbouring row goes on
  double farther_loss = 0.05;  ///< of a seed, for each step, so that ties go to the seed
  double neighbour = 1.6;      ///< of the spacing: between one row's distance and two
  // Of a join: less than half a spacing, so that a neighbouring row does not match, plus about one
  // degree of error in the direction over the gap.
  double off_line = 0.3, off_per_length = 0.02;
  double max_bend_rad = 0.17;  ///< of a join, 10 degrees
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
void take_rows(const CanopyRaster& raster, const std::vector<RowCurve>& rows,
               const RowTrackingOptions& options, TakenSquares& taken);

}  // namespace vinerow::mapping
