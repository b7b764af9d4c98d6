#pragma once
/// Comparison of a map from a synthetic cloud with the truth about its parcel.

#include <vector>

#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"

namespace vinerow::mapping {

/// True row and the row of the map that matches it. Errors are the map's figure less the true one.
struct RowComparison {
  int true_row = 0;
  int mapped_row = -1;  ///< -1: not found, and all other figures are 0
  double bearing_deg = 0.0;
  double first_m = 0.0, last_m = 0.0;  ///< distance of the ends from the true ones, horizontally
  double length_m = 0.0, base_m = 0.0, top_m = 0.0, width_m = 0.0;
  double volume_share = 0.0;  ///< of the true volume
  int gaps = 0, true_gaps = 0;
};

struct MapComparison {
  std::vector<RowComparison> rows;  ///< one per true row that has canopy
  std::vector<int> extra_rows;      ///< rows of the map that match no true row
  double bearing_deg = 0.0, spacing_m = 0.0, volume_share = 0.0;
  double seen_volume_share = 0.0;  ///< the estimate without noise, of the true volume

  int found() const;
  double worst_end_m() const;
  double mean_end_m() const;
};

/// @param map  is moved to the truth's origin if it has its own
MapComparison compare_with_truth(const CloudMap& map, const CloudTruth& truth);

}  // namespace vinerow::mapping
