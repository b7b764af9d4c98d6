#pragma once
/// A histogram of how far points lie outside a hull, side by side.

#include <cstdint>
#include <vector>

namespace vinerow::mapping {

/// How far the points of a row lie outside their hull's sections: max over k of n_k . (y, z) - h_k,
/// m, negative inside.
struct ExcessCounts {
  static constexpr double kLow_m = -0.3, kHigh_m = 0.6, kStep_m = 0.0005;
  static constexpr int kSteps = 1800;
  std::vector<std::int64_t> all;                   ///< by steps of kStep_m from kLow_m
  std::vector<std::vector<std::int64_t>> by_side;  ///< the same by the side that is nearest

  explicit ExcessCounts(int sides)
      : all(kSteps, 0), by_side(sides, std::vector<std::int64_t>(kSteps, 0)) {}
  void add(const ExcessCounts& other);
  /// Excess that `outside` points have more than.
  double level_m(std::int64_t outside) const;
  /// Of the points nearest to side k, by their share in order. NaN where there are none.
  double share_m(int k, double share) const;
  /// Mean of the points nearest to side k without the outermost twentieth at both ends. NaN where
  /// there are none.
  double middle_m(int k) const;
  std::int64_t count(int k) const;
};

}  // namespace vinerow::mapping
