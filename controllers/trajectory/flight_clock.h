#pragma once
/// Clock of a flight. It runs with time, more slowly if the vehicle cannot keep up. It stops at a
/// given time of the flight that must not be passed: the vehicle then holds the corresponding
/// place.

#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::controllers {

class FlightClock {
 public:
  double time_s() const { return time_s_; }
  double rate() const { return rate_; }
  /// Time of the flight at which to stop, s; +infinity: none.
  void set_stop(double stop_s) { stop_s_ = stop_s; }
  /// Before the first advance(): limits the rate so that it can stop. A flight starts at rest.
  void start() {
    rate_ = std::min(rate_, std::sqrt(2.0 * kBraking_per_s * std::max(stop_s_ - time_s_, 0.0)));
  }

  /// Change of the rate towards the wanted one, 1/s.
  double slope_per_s(double wanted_rate) const {
    if (wanted_rate < rate_) return -kSlope_per_s;
    const double braking = calc_braking_per_s();
    if (braking > 0.0) return -braking;
    return wanted_rate > rate_ ? calc_max_per_s() : 0.0;
  }
  void advance(double dt_s, double wanted_rate) {
    const double before = rate_;
    const double braking = calc_braking_per_s();
    if (braking > 0.0) {
      const double slope = std::max(braking, -slope_per_s(wanted_rate));
      rate_ = std::max(before - slope * dt_s, 0.0);
      time_s_ += rate_ > 0.0 ? 0.5 * (before + rate_) * dt_s : 0.5 * before * before / slope;
      return;
    }
    rate_ += std::clamp(wanted_rate - rate_, -kSlope_per_s * dt_s, calc_max_per_s() * dt_s);
    time_s_ += 0.5 * (before + rate_) * dt_s;
  }

 private:
  // At 3 m/s an additional 1.2 m/s2, and 0.75 m/s2 before a stop, which takes 6 m.
  static constexpr double kSlope_per_s = 0.4;
  static constexpr double kBraking_per_s = 0.25;
  static constexpr double kThere_s = 0.005;

  /// Constant braking from here that ends at the stop: rate^2 = 2 braking left. 0: not yet.
  double calc_braking_per_s() const {
    const double left_s = stop_s_ - time_s_;
    if (rate_ == 0.0) return 0.0;
    if (left_s <= kThere_s) return kSlope_per_s;
    const double needed_per_s = 0.5 * rate_ * rate_ / left_s;
    return needed_per_s < kBraking_per_s ? 0.0 : std::min(needed_per_s, kSlope_per_s);
  }
  /// Largest rise of the rate: zero at the stop and shortly before braking.
  double calc_max_per_s() const {
    const double left_s = stop_s_ - time_s_;
    if (left_s <= kThere_s) return 0.0;
    return 0.5 * rate_ * rate_ / left_s > 0.8 * kBraking_per_s ? 0.0 : kSlope_per_s;
  }

  double time_s_ = 0.0;
  double rate_ = 1.0;
  double stop_s_ = std::numeric_limits<double>::infinity();
};

/// Full rate up to wait_m away from the reference, zero from twice that on.
inline double calc_clock_rate(double away_m, double wait_m) {
  return std::clamp(2.0 - away_m / wait_m, 0.0, 1.0);
}

}  // namespace vinerow::controllers
