#pragma once
/// Weeds: tufts on the ground between plant rows.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/api/plant_row.h"
#include "engine/core/random.h"
#include "worlds/mapping/photogrammetry/cloud_extent.h"

namespace vinerow::mapping {

struct WeedsOptions {
  double height_m = 0.0;  ///< of the tallest; 0: no weeds
  double tufts_per_m2 = 0.5;
  double radius_low_m = 0.1, radius_high_m = 0.35;
  double offset_from_rows_m =
      0.35;  ///< free strip on both sides of a row's line, where soil is worked
};

/// Round tufts, highest in the middle: h (1 - r^2 / R^2), with h uniform from 0.3 to 1 of height_m
/// and R uniform between the radii.
class Weeds {
 public:
  Weeds(const WeedsOptions& options, const std::vector<PlantRow>& rows, const SurveyArea& area,
        RandomStream random);

  /// Height of the tallest tuft at a point above the ground; 0 outside all tufts.
  double height_m(const Eigen::Vector2d& p_W) const;

 private:
  struct Tuft {
    Eigen::Vector2d p_W;
    double radius_m, height_m;
  };
  std::size_t cell_of(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(i);
  }

  std::vector<Tuft> tufts_;           ///< by cell
  std::vector<std::uint32_t> first_;  ///< of each cell in tufts_, and one behind
  Eigen::Vector2d corner_W_ = {0, 0};
  double cell_m_ = 1.0;  ///< >= the largest radius
  int columns_ = 0, rows_ = 0;
};

}  // namespace vinerow::mapping
