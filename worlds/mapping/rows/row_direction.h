#pragma once
/// Local direction and spacing of plant rows, window by window, so that curved rows are found too.

#include <Eigen/Core>
#include <vector>

#include "worlds/mapping/rows/canopy_raster.h"

namespace vinerow::mapping {

/// Rows in one round window on the canopy.
struct RowPatch {
  Eigen::Vector2d middle = {0, 0};  ///< of the window, relative to the cloud's origin
  double angle_rad = 0.0;           ///< of the rows from x, counter-clockwise, [0, pi)
  double spacing_m = 0.0;           ///< between rows
  double likelihood = 0.0;          ///< 0: no rows, 1: every alley free and all rows alike
  double canopy_m2 = 0.0;           ///< canopy area in the window
  std::vector<double> offsets_m;    ///< of the rows from the middle, positive to the left
};

struct RowPatchOptions {
  double radius_m = 10.0;
  double spacing_low_m = 1.0, spacing_high_m = 6.0;

  // Thresholds, all chosen.
  double min_canopy = 0.01;  ///< canopy area over R^2, a third of a percent of the window's area
  /// Of R. A shorter chord of the window holds too little canopy. 0.6 R is left at |t| < 0.95 R.
  double min_chord = 0.6;
  /// Of the highest peak of the autocorrelation. The first peak above it is the spacing, later ones
  /// are its multiples; a lower one before it comes from weeds or from the shape of the rows.
  double first_peak = 0.75;
  double min_peak = 0.15;      ///< of the autocorrelation; below is noise
  double row_peak_over = 3.0;  ///< a third of the highest peak of the profile is a row with gaps
  double row_reach = 0.35;     ///< of the spacing: less than half, so that the next row is not met
  double likely = 0.12;        ///< likelihood of a window that agrees with its neighbours
  double clear = 0.25;         ///< and of one that disagrees with most and must be clearer
  /// Share of the surrounding canopy that must agree. At an edge of the parcel, and beside windows
  /// that see no rows clearly, it is well below 1.
  double agreeing = 0.4;
  double parallel_deg = 15.0;         ///< for curved rows
  double narrow = 0.75, wide = 1.33;  ///< of the median spacing: neither half nor twice of it
  // Of other blocks: stricter than for the main one, because fewer windows can agree.
  double other_parallel_deg = 10.0;
  double other_spacing = 1.2;  ///< ratio of two spacings
};

/// Windows over the whole raster, one radius apart, in the raster's order. Windows without canopy
/// are left out; likelihood and spacing are 0 if the canopy is not periodic.
///
/// The angle maximises the mean square of the canopy's profile across it (steps of 2, 0.2 and 0.04
/// degrees). The spacing is the first large peak of that profile's autocorrelation. The likelihood
/// is half the height of that peak above the lowest value before it.
std::vector<RowPatch> find_row_patches(const CanopyRaster& raster, const RowPatchOptions& options);

/// Windows that belong to the rows of the parcel.
///
/// Kept are windows that are likely enough, whose spacing is within about a third of the weighted
/// median, and for which at least two fifths of the canopy within three radii is in windows with
/// rows in the same direction (within 15 degrees). A window on the ends of rows may mistake their
/// edge for a row, and one on a meadow may mistake bushes for it; the last condition removes both.
std::vector<RowPatch> consistent_windows(const std::vector<RowPatch>& patches,
                                         const RowPatchOptions& options);

/// Groups of windows of other blocks, with rows of another direction or spacing than most.
///
/// These are windows that consistent_windows() has left out although they clearly show rows (bushes
/// on a meadow do not). A group is connected: neighbouring windows with the same direction (within
/// 10 degrees) and spacing (within a fifth). Groups of one window are left out; the largest group
/// comes first.
std::vector<std::vector<RowPatch>> other_patches(const std::vector<RowPatch>& patches,
                                                 const std::vector<RowPatch>& consistent,
                                                 const RowPatchOptions& options);

/// Weighted median of the windows' spacings, with weights likelihood x canopy.
/// @pre patches is not empty
double median_spacing_m(const std::vector<RowPatch>& patches);

}  // namespace vinerow::mapping
