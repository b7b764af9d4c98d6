#pragma once
/// Readings in steps.

#include <cmath>

namespace vinerow::sensors {

/// The multiple of `step` nearest to a value, halves away from zero. @param step  0: all values
inline double round_to_step(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

}  // namespace vinerow::sensors
