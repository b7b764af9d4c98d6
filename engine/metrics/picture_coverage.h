#pragma once
/// Coverage of a parcel by the pictures of a survey: number of pictures of each place, and overlap
/// of neighbouring pictures.
///
/// All areas are horizontal. A footprint is the convex hull of the points at which a picture's
/// corners meet the ground, in the plane of W. The overlap of picture A with picture B is
/// area(A and B) / area(A), by clipping. Level flight over level ground gives 1 - step / length
/// ahead and 1 - spacing / width to the side.
///
/// Forward overlap is that of consecutive pictures (index and next index) of one lane, both of
/// which touch the parcel. A place is *covered* by 85 % forward overlap if a pair of consecutive
/// pictures of a lane, both of which see it, overlaps by at least 85 %. The overlap is *held* there
/// if, on some lane, all pairs of consecutive pictures that both see the place overlap by as much.
///
/// Side overlap is that of a picture with the strip of a neighbouring lane. The strip is the hull
/// of the two pictures of that lane that come before and after it along the lanes. Lanes are
/// neighbours by position, not by number.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/api/messages/sensors.h"
#include "engine/api/result_spec.h"
#include "engine/math/polygon.h"

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

/// Cells over the parcel's box, x fastest. A cell is inside the parcel if its centre is.
struct CoverageMap {
  Eigen::Vector2d corner_W = {0, 0};
  double cell_m = 1.0;
  int columns = 0;
  int rows = 0;
  std::vector<std::int32_t> pictures;  ///< number that see the cell's centre; -1 outside the parcel
  /// Held overlap: the smallest overlap of a lane's pairs of consecutive pictures that both see the
  /// cell's centre, on the lane for which it is largest; 0 without such pictures, -1 outside the
  /// parcel.
  std::vector<float> forward_overlap;
  /// See coverage_results(); NaN if there is nothing to measure.
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
///   gsd_formula_error_max, gsd_formula_error_mean: relative excess of their GSD over that of a
///     picture straight down from the same height above the observed ground: largest absolute
///     value, and mean
const std::vector<ResultSpec>& coverage_results();

/// @throws ConfigError if the parcel has fewer than three corners, crosses itself or has no area,
/// or there would be more than 25 million cells
void check_coverage_options(const CoverageOptions& options);

/// @param shots  in chronological order
/// @throws ConfigError as check_coverage_options()
CoverageMap map_coverage(const std::vector<LaneShot>& shots, const CoverageOptions& options);

/// Footprint in the plane of W, counter-clockwise. Empty if the shot is not on the ground.
Polygon footprint_W(const CameraShot& shot);

}  // namespace vinerow::metrics
