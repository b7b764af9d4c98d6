#pragma once
/// Histograms of the excess of points over a hull, for each side.

#include <cstdint>
#include <vector>

namespace vinerow::mapping {

/// Excess of a row's points over their hull's sections: max over k of n_k . (y, z) - h_k, m,
/// negative inside.
struct ExcessCounts {
  static constexpr double kLow_m = -0.3, kHigh_m = 0.6, kStep_m = 0.0005;
  static constexpr int kSteps = 1800;
  std::vector<std::int64_t> all;                   ///< by steps of kStep_m from kLow_m
  std::vector<std::vector<std::int64_t>> by_side;  ///< the same by the side that is nearest

  explicit ExcessCounts(int sides)
      : all(kSteps, 0), by_side(sides, std::vector<std::int64_t>(kSteps, 0)) {}
  void add(const ExcessCounts& other);
  /// Excess that `outside` points exceed.
  double level_m(std::int64_t outside) const;
  /// Quantile `share` of the points nearest to side k. NaN without points.
  double share_m(int k, double share) const;
  /// Mean of the points nearest to side k without the lowest and highest twentieth. NaN without
  /// points.
  double middle_m(int k) const;
  std::int64_t count(int k) const;
};

}  // namespace vinerow::mapping
