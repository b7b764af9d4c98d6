#pragma once
/// Coming to stand at a place along a path, and standing there: what a movement authority asks of
/// ground vehicles.
///
/// The speed from which a vehicle stands after `left` metres if it begins to brake `reaction_s`
/// late: v = sqrt((a t)^2 + 2 a left) - a t, an even braking that ends in an exponential approach
/// with time constant t; so wheels and estimates that lag do not carry it beyond. It aims a little
/// short of the place, and once it stands it stays until the place has moved on by more than what
/// an estimate jumps: it does not creep after the noise.

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/path.h"
#include "engine/api/signal.h"

namespace vinerow::controllers {

class StopProfile {
 public:
  static constexpr double kShort_m = 0.1;    ///< aims so far before the place
  static constexpr double kThere_m = 0.02;   ///< nearer to where it aims is there
  static constexpr double kResume_m = 0.15;  ///< farther from it is on the way again
  static constexpr double kReaction_s = 0.3;

  /// @param deceleration_mps2  > 0
  explicit StopProfile(double deceleration_mps2) : deceleration_mps2_(deceleration_mps2) {}

  /// @param stop_at_m  along the path; +infinity: none
  void set_place(double stop_at_m) { stop_at_m_ = stop_at_m; }
  /// Another path: it does not stand any more.
  void reset() { is_holding_ = false; }

  /// Once per cycle. @returns the largest speed forwards, m/s; 0: stand; +infinity without a place
  double update(double distance_m) {
    left_m_ = stop_at_m_ - kShort_m - distance_m;
    is_holding_ = left_m_ <= (is_holding_ ? kResume_m : kThere_m);
    if (is_holding_) return 0.0;
    const double late_mps = deceleration_mps2_ * kReaction_s;
    return std::sqrt(late_mps * late_mps + 2.0 * deceleration_mps2_ * left_m_) - late_mps;
  }

  /// As of the last update().
  bool is_holding() const { return is_holding_; }
  /// Way from there to where it is to stand, m; not negative.
  double left_m() const { return std::max(left_m_, 0.0); }

 private:
  double deceleration_mps2_;
  double stop_at_m_ = std::numeric_limits<double>::infinity();
  double left_m_ = std::numeric_limits<double>::infinity();
  bool is_holding_ = false;
};

/// Where the optional signal "authority" lets a vehicle go to; +infinity where nobody writes it.
inline double read_stop_at_m(const SignalReader<MovementAuthority>& authority) {
  return authority.has_value() ? authority.value().stop_at_m
                               : std::numeric_limits<double>::infinity();
}

}  // namespace vinerow::controllers
