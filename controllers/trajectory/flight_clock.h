#pragma once
/// The clock of a flight. It runs with time, and more slowly where the vehicle cannot keep up.

#include <algorithm>

namespace vinerow {

class FlightClock {
 public:
  double time_s() const { return time_s_; }
  double rate() const { return rate_; }
  /// Change of the rate on the way to the wanted one, 1/s.
  double slope_per_s(double wanted_rate) const {
    if (wanted_rate > rate_) return kSlope_per_s;
    return wanted_rate < rate_ ? -kSlope_per_s : 0.0;
  }
  void advance(double dt_s, double wanted_rate) {
    const double before = rate_;
    const double most = kSlope_per_s * dt_s;
    rate_ += std::clamp(wanted_rate - rate_, -most, most);
    time_s_ += 0.5 * (before + rate_) * dt_s;
  }

 private:
  // At 3 m/s as much as 1.2 m/s2 more.
  static constexpr double kSlope_per_s = 0.4;
  double time_s_ = 0.0;
  double rate_ = 1.0;
};

/// Full rate up to wait_m away from the reference, none from twice that on.
inline double calc_clock_rate(double away_m, double wait_m) {
  return std::clamp(2.0 - away_m / wait_m, 0.0, 1.0);
}

}  // namespace vinerow
