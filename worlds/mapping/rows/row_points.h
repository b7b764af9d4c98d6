#pragma once
/// Tells a cloud's points apart and hands every row the points of its canopy.

#include <vector>

#include "worlds/mapping/rows/cloud_terrain.h"
#include "worlds/mapping/rows/row_canopy.h"

namespace vinerow::mapping {

struct RowPointOptions {
  double spacing_m = 2.5;            ///< between rows: half of it is how far a canopy may reach
  std::vector<double> spacing_of_m;  ///< of each line, where blocks differ; empty: spacing_m
  double canopy_cut_m = 0.55;        ///< above the ground
  double body_cut_m = 1.0;           ///< what is higher is a row's as far as half the spacing
  double ground_m = 0.15;            ///< points up to so high are ground
};

/// Where canopy begins above the ground, for a stretch of a row.
struct CanopyBase {
  double stretch_m = 2.0;
  std::vector<float> height_m;  ///< of stretch k
};

/// Points of the rows' canopies, in the cloud's order, and a class for every point of the cloud.
/// Canopy is what is higher than the body's cut beside a row, and below it what lies within the
/// width that the body has: higher than the canopy's cut, and below that cut what hangs together
/// with the canopy: going down, until fewer than half as many points lie at a height as above the
/// cut. Where they go on to the ground (weeds in the row) the cut stays.
/// @param lines  of the rows, from the cloud's origin
/// @returns one per line, with lines in W
std::vector<RowCanopy> gather_row_canopies(ParcelCloud& cloud, const HeightField& terrain,
                                           const std::vector<RowCurve>& lines,
                                           const RowPointOptions& options);

}  // namespace vinerow::mapping
