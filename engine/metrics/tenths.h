#pragma once
/// Detector of stretches that were passed from one end to the other: in each of their tenths.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/metrics/spread.h"

namespace vinerow::metrics {

class Tenths {
 public:
  /// Adds the vehicle's place on the stretch. The section between two consecutive looks counts as
  /// passed if it is at most twice as long as the distance moved. If it is longer, the vehicle
  /// cannot have driven along it.
  /// @param share  distance along the stretch divided by its length, 0..1
  /// @param moved_share  distance moved since the last look, divided by the stretch's length
  void look(double share, double moved_share) {
    const bool went_on = std::abs(share - last_) <= 2.0 * moved_share;  // false at the first look
    const int from = tenth(went_on ? std::min(share, last_) : share);
    const int to = tenth(went_on ? std::max(share, last_) : share);
    for (int k = from; k <= to; ++k) seen_ |= 1u << k;
    last_ = share;
  }
  /// The vehicle is not on the stretch now.
  void leave() { last_ = kNotMeasured; }
  bool all() const { return seen_ == (1u << kCount) - 1u; }

 private:
  static constexpr int kCount = 10;
  static int tenth(double share) {
    return std::clamp(static_cast<int>(share * kCount), 0, kCount - 1);
  }
  std::uint32_t seen_ = 0;
  double last_ = kNotMeasured;
};

}  // namespace vinerow::metrics
