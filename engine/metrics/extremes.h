#pragma once
/// Running minimum and maximum.

#include <algorithm>
#include <limits>

#include "engine/metrics/spread.h"

namespace vinerow::metrics {

struct Extremes {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();

  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }
  double min_or_nan() const { return min <= max ? min : kNotMeasured; }
  double max_or_nan() const { return min <= max ? max : kNotMeasured; }
};

}  // namespace vinerow::metrics
