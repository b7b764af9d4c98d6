#pragma once
/// Which way rows run and how far apart they are, place by place: so curved rows are found too.

#include <Eigen/Core>
#include <vector>

#include "worlds/mapping/rows/canopy_raster.h"

namespace vinerow::mapping {

/// What one round window on the canopy shows.
struct RowPatch {
  Eigen::Vector2d middle = {0, 0};  ///< of the window, from the cloud's origin
  double angle_rad = 0.0;           ///< of the rows from x, counter-clockwise, [0, pi)
  double spacing_m = 0.0;           ///< between rows
  double likelihood = 0.0;          ///< 0: no rows, 1: every alley free and all rows alike
  double canopy_m2 = 0.0;           ///< in the window
  std::vector<double> offsets_m;    ///< of the rows from the middle, to the left of the angle
};

struct RowPatchOptions {
  double radius_m = 10.0;
  double spacing_low_m = 1.0, spacing_high_m = 6.0;
};

/// Windows every radius over the raster, those without canopy left out, in the raster's order;
/// likelihood and spacing are 0 where nothing repeats itself. The angle is the one under which the
/// canopy's profile across it has the largest mean square (steps of 2, 0.2 and 0.04 degrees), the
/// spacing the first large peak of that profile's autocorrelation, the likelihood half its height
/// above the trough before it.
std::vector<RowPatch> find_row_patches(const CanopyRaster& raster, const RowPatchOptions& options);

/// Those that belong to rows: likely enough, of a spacing that most canopy has (within a third),
/// and with two fifths of the canopy within three radii in windows of rows that run as these do
/// (within 15 degrees): a window that sees little more than the ends of rows may take their edge
/// for a row, and one on a meadow some bushes.
std::vector<RowPatch> agreeing_patches(const std::vector<RowPatch>& patches,
                                       const RowPatchOptions& options);

/// Windows that agreeing_patches() has left out though they show rows clearly (bushes on a meadow
/// do not), by groups that hang together: side by side, in one direction (within 10 degrees), of
/// one spacing (within a fifth). Blocks that run another way than most, or stand closer. Groups of
/// one window are left out; the largest comes first.
std::vector<std::vector<RowPatch>> other_patches(const std::vector<RowPatch>& patches,
                                                 const std::vector<RowPatch>& agreeing,
                                                 const RowPatchOptions& options);

/// Middle of the windows' spacings, each as heavy as its canopy is likely to be rows.
/// @pre not empty
double median_spacing_m(const std::vector<RowPatch>& patches);

}  // namespace vinerow::mapping
