#pragma once
/// Running root mean square and largest absolute value.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vinerow::metrics {

/// Value of a metric that had nothing to measure.
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

struct Spread {
  double sum_squares = 0.0;
  double max = 0.0;
  std::int64_t count = 0;

  void add(double value) {
    sum_squares += value * value;
    // A NaN must stay in max, although every comparison with it is false.
    if (!(std::abs(value) <= max)) max = std::isnan(max) ? max : std::abs(value);
    ++count;
  }
  double rms() const {
    return count ? std::sqrt(sum_squares / static_cast<double>(count)) : kNotMeasured;
  }
  double max_or_nan() const { return count ? max : kNotMeasured; }
};

}  // namespace vinerow::metrics
