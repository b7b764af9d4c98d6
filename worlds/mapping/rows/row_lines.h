#pragma once
/// From rough tracks to the lines of plant rows: middle, straight or curved, and both ends.

#include <vector>

#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/row_tracking.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

struct RowLineOptions {
  double spacing_m = 2.5;
  double length_low_m = 5.0;  ///< shorter rows are left out
};

/// Lines from the cloud's origin, from the canopy's first point to its last, in the order and
/// direction of order_rows(). The middle of the canopy every metre; where these lie within 6 cm of
/// one straight line (means over 10 m) the row is that line of two points, else a smooth one of a
/// point every 2 m. An end is where canopy of at least 0.6 m in one piece begins (a vine, not a
/// stay) that leaves the alleys beside it free (a row, not a tree or a hedge across). Left out:
/// short ones, lines with canopy along less than half of them or as much beside them (bushes), and
/// what no other row runs beside at 0.6 to 1.6 times the spacing (hedges).
std::vector<RowCurve> fit_row_lines(const CanopyRaster& raster, const std::vector<RowTrack>& tracks,
                                    const RowLineOptions& options);

/// Rows of one block by order_rows(), the longest one from south to north. @pre not empty
std::vector<RowCurve> order_block(std::vector<RowCurve> rows);

}  // namespace vinerow::mapping
