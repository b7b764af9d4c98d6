#pragma once
/// Root mean square and largest size of a number, sample by sample.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vinerow::metrics {

/// What a metric says where it had nothing to measure.
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

struct Spread {
  double sum_squares = 0.0;
  double max = 0.0;
  std::int64_t count = 0;

  void add(double value) {
    sum_squares += value * value;
    // A NaN stays: a comparison with it is false, whichever way round.
    if (!(std::abs(value) <= max)) max = std::isnan(max) ? max : std::abs(value);
    ++count;
  }
  double rms() const {
    return count ? std::sqrt(sum_squares / static_cast<double>(count)) : kNotMeasured;
  }
  double max_or_nan() const { return count ? max : kNotMeasured; }
};

}  // namespace vinerow::metrics
