#pragma once
/// Smoothing of evenly spaced samples by moving averages. It is symmetric and keeps straight lines.

#include <algorithm>
#include <cmath>
#include <vector>

namespace vinerow::controllers {

/// Values assumed before the first and after the last sample.
enum class Beyond {
  kTurnedAbout,  ///< the samples rotated by half a turn about the end, which keeps the end in place
  kConstant      ///< the end's value
};

/// Number of samples on either side of a moving average about `width_m` wide.
inline int calc_half_window(double width_m, double step_m) {
  return std::max(0, static_cast<int>(std::lround(0.5 * width_m / step_m)));
}

/// Moving average over `half` steps to either side; the outermost samples have half weight.
/// @param half  >= 0; 0: the samples themselves
template <class T>
std::vector<T> smooth_box(const std::vector<T>& samples, int half, Beyond beyond) {
  const int last = static_cast<int>(samples.size()) - 1;
  const auto at = [&](int i) -> T {
    if (i >= 0 && i <= last) return samples[i];
    const int end = i < 0 ? 0 : last;
    if (beyond == Beyond::kConstant) return samples[end];
    return 2.0 * samples[end] - samples[std::clamp(2 * end - i, 0, last)];
  };
  if (half == 0) return samples;
  std::vector<T> smooth;
  smooth.reserve(samples.size());
  for (int i = 0; i <= last; ++i) {
    T sum = at(i);
    for (int k = 1; k < half; ++k) sum += at(i - k) + at(i + k);
    sum += 0.5 * (at(i - half) + at(i + half));
    smooth.push_back(sum / (2.0 * half));
  }
  return smooth;
}

/// Largest of the 2 half + 1 samples around each sample.
inline std::vector<double> dilate(const std::vector<double>& samples, int half) {
  const int last = static_cast<int>(samples.size()) - 1;
  std::vector<double> largest;
  largest.reserve(samples.size());
  for (int i = 0; i <= last; ++i) {
    const auto from = samples.begin() + std::max(0, i - half);
    const auto to = samples.begin() + std::min(last, i + half) + 1;
    largest.push_back(*std::max_element(from, to));
  }
  return largest;
}

}  // namespace vinerow::controllers
