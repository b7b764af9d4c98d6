#pragma once
/// A row's canopy points without strays, cut at gaps and into slices along the row.

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "worlds/mapping/rows/row_canopy.h"

namespace vinerow::mapping {

struct RowSliceOptions {
  double slice_m = 0.14;
  double cell_m = 0.08;
  double gap_m = 0.5;
};

/// Canopy without a gap.
struct RowStretch {
  double from_m = 0.0, to_m = 0.0;  ///< where the canopy ends, noise left out
  /// (s, y, z), by slices of equal length from from_m to to_m; what is beyond the ends belongs to
  /// the first and last.
  std::vector<Eigen::Vector3f> points;
  std::vector<std::size_t> first;  ///< point of each slice, and one behind the last

  int slices() const { return static_cast<int>(first.size()) - 1; }
  double slice_m() const { return (to_m - from_m) / slices(); }
  double knot_m(int j) const { return j == slices() ? to_m : from_m + j * slice_m(); }
};

struct RowStretches {
  std::vector<RowStretch> stretches;              ///< in order
  std::vector<std::pair<double, double>> gaps_m;  ///< between them
  std::int64_t sparse = 0;                        ///< points in sparse cells
  std::int64_t lone = 0;                          ///< in stretches too short for a mesh
  std::int64_t not_finite = 0;
};

/// Sparse is a cell of cell_m x cell_m x slice_m whose neighbourhood of 3 x 3 x 3 cells holds less
/// than 3 % of the points that it does for the median point within 1 m along the row, or 1 % of the
/// whole row's median, or no more than two points in a row that is denser: the low parts of canopy
/// that pictures hardly see are sparse too, and what strays is left outside by the fit. So it is
/// the same share at 200 and at 1500 points/m2. Slices are made longer where they would hold fewer
/// than 60 points on average.
RowStretches slice_row(const RowCanopy& row, const RowSliceOptions& options);

}  // namespace vinerow::mapping
