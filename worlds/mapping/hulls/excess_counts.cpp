#include "worlds/mapping/hulls/excess_counts.h"

#include <limits>

namespace vinerow::mapping {

void ExcessCounts::add(const ExcessCounts& other) {
  for (int i = 0; i < kSteps; ++i) all[i] += other.all[i];
  for (std::size_t k = 0; k < by_side.size(); ++k) {
    for (int i = 0; i < kSteps; ++i) by_side[k][i] += other.by_side[k][i];
  }
}

double ExcessCounts::level_m(std::int64_t outside) const {
  std::int64_t passed = 0;
  for (int i = kSteps - 1; i >= 0; --i) {
    passed += all[i];
    if (passed > outside) return kLow_m + (i + 1) * kStep_m;
  }
  return kLow_m;
}

std::int64_t ExcessCounts::count(int k) const {
  std::int64_t sum = 0;
  for (const std::int64_t n : by_side[k]) sum += n;
  return sum;
}

double ExcessCounts::share_m(int k, double share) const {
  const double wanted = share * static_cast<double>(count(k));
  std::int64_t passed = 0;
  for (int i = 0; i < kSteps; ++i) {
    passed += by_side[k][i];
    if (passed > 0 && static_cast<double>(passed) >= wanted) return kLow_m + (i + 0.5) * kStep_m;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double ExcessCounts::middle_m(int k) const {
  const double low_m = share_m(k, 0.05), high_m = share_m(k, 0.95);
  double sum = 0.0, weight = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double excess_m = kLow_m + (i + 0.5) * kStep_m;
    if (!(excess_m >= low_m && excess_m <= high_m)) continue;
    sum += static_cast<double>(by_side[k][i]) * excess_m;
    weight += static_cast<double>(by_side[k][i]);
  }
  return sum / weight;
}

}  // namespace vinerow::mapping
