#pragma once
/// Lines of plant rows, fitted to rough tracks: middle (straight or curved) and both ends.

#include <vector>

#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/row_tracking.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

struct RowLineOptions {
  double spacing_m = 2.5;
  double length_low_m = 5.0;  ///< shorter rows are left out
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
