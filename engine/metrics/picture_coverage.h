#pragma once
/// What the pictures of a survey show of a parcel: how many see each place, and how much
/// neighbouring pictures have in common.
///
/// Everything is seen from above: a footprint is the convex hull of where a picture's corners meet
/// the ground, in the plane of W. Overlap of picture A with picture B: area(A and B) / area(A), by
/// clipping, so that level flight over level ground gives 1 - step / length ahead and
/// 1 - spacing / width to the side.
///
/// Forward overlap is that of consecutive pictures (index and next index) of one lane, both of
/// which touch the parcel. A place is *covered* by 85 % forward overlap where consecutive pictures
/// of a lane see it that have at least 85 % in common; that overlap is *held* there where, on some
/// lane, all consecutive pictures that both see the place have as much in common.
///
/// Side overlap is that of a picture with the strip of a neighbouring lane, where the strip is the
/// hull of those two pictures of that lane between which it was taken; lanes are neighbours by
/// their place, not by their number.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/api/messages/sensors.h"
#include "engine/math/polygon.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

/// A picture and the lane it was taken on; -1: between lanes.
struct LaneShot {
  CameraShot shot;
  int lane = -1;
};

struct CoverageOptions {
  Polygon parcel_W;
  double cell_m = 1.0;
  double wanted_overlap = 0.85;
};

/// Cells over the parcel's box, x fastest; a cell is inside where its middle is.
struct CoverageMap {
  Eigen::Vector2d corner_W = {0, 0};
  double cell_m = 1.0;
  int columns = 0;
  int rows = 0;
  std::vector<std::int32_t> pictures;  ///< that see the cell's middle; -1 outside the parcel
  /// What is held there: of the consecutive pictures of a lane that both see the cell's middle the
  /// smallest overlap, on the lane where that is largest; 0 without such pictures, -1 outside the
  /// parcel.
  std::vector<float> forward_overlap;
  /// See coverage_numbers(); NaN where there is nothing to measure.
  std::map<std::string, double> numbers;

  std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// shots, shots_off_ground (a corner meets no ground: these count nowhere else), and
///   covered_share, covered_twice_share, covered_three_times_share: of the parcel's cells
///   overlap_covered_share, overlap_held_share: of the parcel's cells, with the wanted overlap
///   forward_overlap_min, forward_overlap_mean, side_overlap_min, side_overlap_mean
///   gsd_min_m, gsd_mean_m, gsd_max_m: of the pictures that touch the parcel
///   gsd_formula_error_max, gsd_formula_error_mean: by how much, as a share, their GSD exceeds that
///     of a picture straight down from the same height above the ground they look at; the size of
///     it, and its mean
const std::vector<MetricNumber>& coverage_numbers();

/// @throws ConfigError if the parcel has fewer than three corners, crosses itself or has no area,
/// or there would be more than 25 million cells
void check_coverage_options(const CoverageOptions& options);

/// @param shots  in the order in which they were taken
/// @throws ConfigError as check_coverage_options()
CoverageMap map_coverage(const std::vector<LaneShot>& shots, const CoverageOptions& options);

/// Seen from above, counter-clockwise. Empty where the shot is not on the ground.
Polygon footprint_W(const CameraShot& shot);

}  // namespace vinerow::metrics
