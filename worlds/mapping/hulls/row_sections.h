#pragma once
/// Canopy points of a row without strays, divided at gaps and into slices along the row.

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "worlds/mapping/rows/row_canopy.h"

namespace vinerow::mapping {

/// Thresholds of slice_row(), all chosen.
struct RowSliceThresholds {
  // Sparse cells, as shares of the median point's neighbourhood.
  double local = 0.03;      ///< of that within 1 m along the row
  double row = 0.01;        ///< of that of the whole row
  double stray = 2.5;       ///< points: one or two alone, unless the whole row is as sparse
  double stray_row = 0.15;  ///< of the whole row's median: its limit for `stray`
  // Stretches.
  double occupied = 0.05;          ///< of the median step's points that is canopy
  double shortest_m = 0.25;        ///< shorter stretches are posts, or strays that stand together
  double fewest_points = 24.0;     ///< of a stretch
  double points_per_slice = 60.0;  ///< slices are longer if they would contain fewer
  // Ends.
  double end_share = 0.02;  ///< of the points of an end that noise has carried beyond it
  double end_m = 0.3;       ///< length of an end
};

struct RowSliceOptions {
  double slice_m = 0.14;
  double cell_m = 0.08;
  double gap_m = 0.5;
  RowSliceThresholds thresholds = {};
};

/// Canopy without a gap.
struct RowStretch {
  double from_m = 0.0, to_m = 0.0;  ///< ends of the canopy, without noise
  /// (s, y, z), by slices of equal length from from_m to to_m. Points beyond the ends belong to the
  /// first and last slice.
  std::vector<Eigen::Vector3f> points;
  std::vector<std::size_t> first;  ///< index of each slice's first point, and one past the last

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

/// Removes sparse cells, and divides the row. A cell of cell_m x cell_m x slice_m is sparse if its
/// neighbourhood of 3 x 3 x 3 cells contains less than 3 % of the points in that of the median
/// point within 1 m along the row, less than 1 % of the whole row's median, or at most two points
/// in a denser row. The thresholds are low because the low parts of a canopy, which pictures hardly
/// show, are sparse too; the fit leaves remaining strays outside. The shares are the same at 200
/// and at 1500 points/m2. Slices are longer if they would contain fewer than 60 points on average.
RowStretches slice_row(const RowCanopy& row, const RowSliceOptions& options);

}  // namespace vinerow::mapping
