#pragma once
/// Order statistics of samples.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/core/check.h"

namespace vinerow {

/// Value at an index of the ascending order, in linear time.
/// @param values  reordered @pre index < values.size()
template <class T>
T value_in_order(std::vector<T>& values, std::size_t index) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Median; of an even number of values the larger of the two in the middle.
/// @param values  reordered @pre not empty
template <class T>
T upper_median(std::vector<T>& values) {
  return value_in_order(values, values.size() / 2);
}

/// Quantile with linear interpolation between values.
///
/// Source: definition 7 of Hyndman, Fan, "Sample quantiles in statistical packages", The American
/// Statistician 50 (1996).
///
/// @param sorted  (n) ascending and finite, n >= 1 (checked)
/// @param share   0 to 1 (checked): 0.5 is the median
inline double quantile(std::span<const double> sorted, double share) {
  VINEROW_DEMAND(!sorted.empty() && share >= 0.0 && share <= 1.0);
  VINEROW_DEMAND(std::is_sorted(sorted.begin(), sorted.end()));
  VINEROW_DEMAND(std::isfinite(sorted.front()) && std::isfinite(sorted.back()));
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= sorted.size()) return sorted.back();
  return std::lerp(sorted[below], sorted[below + 1], place - static_cast<double>(below));
}

}  // namespace vinerow
