#pragma once
/// Whether a stretch was passed from one end to the other: it has when each of its tenths was.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/metrics/spread.h"

namespace vinerow::metrics {

class Tenths {
 public:
  /// Looks at where the vehicle is on the stretch. What lies between two looks in a row was passed
  /// too, if the vehicle moved at least half as far: then it did not come there some other way.
  /// @param share  of the stretch that lies behind, 0..1
  /// @param moved_share  how far it moved since the last look, over the stretch's length
  void look(double share, double moved_share) {
    const bool went_on = std::abs(share - last_) <= 2.0 * moved_share;  // false at the first look
    const int from = tenth(went_on ? std::min(share, last_) : share);
    const int to = tenth(went_on ? std::max(share, last_) : share);
    for (int k = from; k <= to; ++k) seen_ |= 1u << k;
    last_ = share;
  }
  /// It is not on the stretch now.
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
