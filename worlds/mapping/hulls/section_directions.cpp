#include "worlds/mapping/hulls/section_directions.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/math/angles.h"

namespace vinerow::mapping {

float upper_level(std::vector<float>& values) {
  constexpr double kStartShare = 0.01;
  const auto above = static_cast<std::ptrdiff_t>(kStartShare * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + above, values.end(), std::greater<>());
  return values[static_cast<std::size_t>(above)];
}

HullDirections choose_directions(const std::vector<RowStretch>& stretches, int corners) {
  constexpr int kFine = 32;
  constexpr int kSlices = 64;  // looked at
  std::vector<double> angles;
  for (int k = 0; k < kFine; ++k) angles.push_back(2.0 * kPi * k / kFine - kPi);
  const HullDirections fine(angles);
  std::size_t slices = 0;
  for (const RowStretch& stretch : stretches) slices += static_cast<std::size_t>(stretch.slices());
  const std::size_t every = std::max<std::size_t>(1, slices / kSlices);
  std::vector<double> supports;  // of each slice looked at in each direction
  std::size_t at = 0;
  std::vector<float> values;
  for (const RowStretch& stretch : stretches) {
    for (int i = 0; i < stretch.slices(); ++i, ++at) {
      const std::size_t begin = stretch.first[i], end = stretch.first[i + 1];
      if (at % every != 0 || end - begin < 8) continue;
      const std::size_t row = supports.size();
      for (int k = 0; k < kFine; ++k) {
        const Eigen::Vector2f n = fine.normal(k).cast<float>();
        values.clear();
        for (std::size_t p = begin; p < end; ++p) {
          values.push_back(n.x() * stretch.points[p].y() + n.y() * stretch.points[p].z());
        }
        supports.push_back(upper_level(values));
      }
      fine.repair(supports.data() + row, 1e-4);
    }
  }
  std::vector<int> kept(kFine);
  for (int k = 0; k < kFine; ++k) kept[k] = k;
  while (static_cast<int>(kept.size()) > corners) {
    double min_m2 = std::numeric_limits<double>::infinity();
    std::size_t out = 0;
    const std::size_t n = kept.size();
    for (std::size_t k = 0; k < n; ++k) {
      const int before = kept[(k + n - 1) % n], own = kept[k], behind = kept[(k + 1) % n];
      const double step = 2.0 * kPi / kFine;
      const double a = step * ((own - before + kFine) % kFine);
      const double b = step * ((behind - own + kFine) % kFine);
      if (a + b > 0.9 * kPi) continue;  // sides that meet at a sharp angle reach far out
      // The triangle over the side that is taken away.
      const double per_m2 = std::sin(a) * std::sin(b) / (2.0 * std::sin(a + b));
      double added_m2 = 0.0;
      for (std::size_t row = 0; row < supports.size(); row += kFine) {
        const double* h = supports.data() + row;
        const double side_m = std::max(0.0, h[before] / std::sin(a) + h[behind] / std::sin(b) -
                                                h[own] * (1.0 / std::tan(a) + 1.0 / std::tan(b)));
        added_m2 += side_m * side_m * per_m2;
      }
      if (added_m2 < min_m2) {
        min_m2 = added_m2;
        out = k;
      }
    }
    if (min_m2 == std::numeric_limits<double>::infinity()) break;
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(out));
  }
  std::vector<double> chosen;
  for (const int k : kept) chosen.push_back(angles[k]);
  return HullDirections(std::move(chosen));
}

}  // namespace vinerow::mapping
