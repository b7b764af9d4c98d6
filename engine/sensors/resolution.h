#pragma once
/// Quantisation of readings.

#include <cmath>

namespace vinerow::sensors {

/// Multiple of `step` nearest to a value, halves away from zero. @param step  0: no rounding
inline double round_to_step(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

}  // namespace vinerow::sensors
