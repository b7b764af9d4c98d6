#pragma once
/// Power spectra of samples by Welch's method, for tests.

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

namespace vinerow::test {

/// In-place radix-2 transform. @param x  size a power of two
inline void transform(std::vector<std::complex<double>>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t length = 2; length <= n; length <<= 1) {
    const std::complex<double> root =
        std::polar(1.0, -2.0 * std::numbers::pi / static_cast<double>(length));
    for (std::size_t i = 0; i < n; i += length) {
      std::complex<double> w = 1.0;
      for (std::size_t k = 0; k < length / 2; ++k, w *= root) {
        const std::complex<double> even = x[i + k], odd = w * x[i + k + length / 2];
        x[i + k] = even + odd;
        x[i + k + length / 2] = even - odd;
      }
    }
  }
}

/// One-sided density over the wave number in rad/m: its sum times the spacing is the variance.
struct Spectrum {
  double spacing_radpm = 0.0;
  std::vector<double> density;  ///< at 0, spacing, 2 spacing, ...
  int segments = 0;
};

/// Hann windows, half overlapping. @param step_m  between samples  @param segment  power of two
inline Spectrum welch(const std::vector<double>& samples, double step_m, std::size_t segment) {
  std::vector<double> window(segment);
  double power = 0.0;
  for (std::size_t i = 0; i < segment; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                     static_cast<double>(segment));
    power += window[i] * window[i];
  }
  Spectrum spectrum;
  spectrum.density.assign(segment / 2, 0.0);
  std::vector<std::complex<double>> x(segment);
  for (std::size_t start = 0; start + segment <= samples.size(); start += segment / 2) {
    for (std::size_t i = 0; i < segment; ++i) x[i] = window[i] * samples[start + i];
    transform(x);
    for (std::size_t k = 0; k < segment / 2; ++k) spectrum.density[k] += std::norm(x[k]);
    ++spectrum.segments;
  }
  spectrum.spacing_radpm = 2.0 * std::numbers::pi / (static_cast<double>(segment) * step_m);
  for (double& value : spectrum.density) {
    value *= step_m / (std::numbers::pi * power * spectrum.segments);
  }
  return spectrum;
}

}  // namespace vinerow::test
