#pragma once
/// Classification of a cloud's points, and assignment of canopy points to rows.

#include <vector>

#include "worlds/mapping/rows/cloud_terrain.h"
#include "worlds/mapping/rows/row_canopy.h"

namespace vinerow::mapping {

struct RowPointOptions {
  double spacing_m = 2.5;            ///< between rows; a canopy reaches up to half of it
  std::vector<double> spacing_of_m;  ///< of each line, if blocks differ; empty: spacing_m
  double canopy_cut_m = 0.55;        ///< above the ground
  double body_cut_m = 1.0;           ///< higher points belong to a row up to half the spacing
  double ground_m = 0.15;            ///< points up to this height are ground
};

/// Lower edge of the canopy above the ground, for each stretch of a row.
struct CanopyBase {
  double stretch_m = 2.0;
  std::vector<float> height_m;  ///< of stretch k
};

/// Canopy points of the rows, in the cloud's order, and a class for every point of the cloud.
/// Points near a row are canopy if they are above the body's cut, or, within the width of that
/// body, above the canopy's cut or connected with the canopy below that cut: downwards until a
/// height has fewer than half as many points as above the cut. If they continue to the ground
/// (weeds in the row), the cut stays.
/// @param lines  of the rows, relative to the cloud's origin
/// @returns one per line, with lines in W
std::vector<RowCanopy> gather_row_canopies(ParcelCloud& cloud, const HeightField& terrain,
                                           const std::vector<RowCurve>& lines,
                                           const RowPointOptions& options);

}  // namespace vinerow::mapping
