#pragma once
/// Lines of plant rows, fitted to rough tracks: middle (straight or curved) and both ends.

#include <vector>

#include "worlds/mapping/model/row_curve.h"
#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/row_tracking.h"

namespace vinerow::mapping {

struct RowLineOptions {
  double spacing_m = 2.5;
  double length_low_m = 5.0;  ///< shorter rows are left out

  // Thresholds, all chosen.
  double across = 0.4;  ///< of the spacing: the reach of a row, as in RowTrackingOptions
  // Middles of the canopy.
  double half_window_m = 0.75;  ///< windows 1 m apart overlap, so that two see each vine
  double min_weight = 1.0;      ///< average squares in a window; less is a stray point
  // The line through them.
  double straight_m = 0.06;  ///< half a raster square; a smaller bend is noise
  /// Length of the means that must be straight: a single middle is off by the shape of its vine,
  /// ten vines average that out, and the bend of a curved row still shows.
  double mean_m = 10.0;
  double smooth_reach_m = 8.0;  ///< 16 middles for the 3 unknowns of a parabola
  double min_side_m = 2.0;      ///< with middles less far to one side a parabola extrapolates
  double max_shift_m = 1.0;     ///< a larger one is a failed fit, and the old point is kept
  // The ends.
  double beyond_ends_m = 4.0;  ///< that are searched: a track ends a step or two from the canopy
  double longest_gap_m = 2.0;  ///< before the last canopy; a longer one is a headland
  double core = 0.4;           ///< of the half alley: the row itself
  double low = 0.45;       ///< of the median canopy: a thin vine passes, a post or a stay does not
  double run_m = 0.6;      ///< in one piece: a vine, not a post or the stay behind the last one
  double wide = 0.6;       ///< canopy beside over that on the line; an even cover has 1.5
  double wide_over = 2.0;  ///< the same over its median, for rows that are wide throughout
  double cut_off_m = 1.5;  ///< cut off at an end, after which the line is fitted again
  // What is a row.
  double covered = 0.45;       ///< of its metres: missing vines pass, chains of bushes do not
  double min_canopy_m2 = 0.1;  ///< in a metre that counts as covered
  double contrast = 3.0;       ///< canopy on the row over that in the alleys beside it
  // Of the spacing: the row, and its alleys to a little beyond their middle at 0.5. The reach of
  // shoots between them belongs to neither.
  double row_share = 0.2, alley_from = 0.4, alley_to = 0.6;
  // Of the spacing: a neighbour. Blocks are planted evenly, and a hedge is farther away.
  double neighbour_near = 0.6, neighbour_far = 1.6;
};

/// Row lines from the first canopy to the last, relative to the cloud's origin, in the order and
/// direction of order_rows().
///
/// The line follows the middle of the canopy, taken every metre. If these middles (means over 10 m)
/// are within 6 cm of one straight line, the row is that line with two points; else it is a smooth
/// curve with a point every 2 m. A row ends with the last canopy that is at least 0.6 m long in one
/// piece (a vine, not a stay) and leaves the alleys beside it free (not a tree or a hedge across).
///
/// Left out are short lines; lines with canopy along less than 45 % of their length, or with more
/// than a third as much canopy beside them as on them (bushes); and lines without a parallel
/// neighbour at 0.6 to 1.6 times the spacing (hedges).
std::vector<RowCurve> fit_row_lines(const CanopyRaster& raster, const std::vector<RowTrack>& tracks,
                                    const RowLineOptions& options);

/// Rows of one block in the order of order_rows(), the longest one from south to north.
/// @pre rows is not empty
std::vector<RowCurve> order_block(std::vector<RowCurve> rows);

}  // namespace vinerow::mapping
