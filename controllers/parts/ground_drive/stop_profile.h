#pragma once
/// Speed profile of a ground vehicle that stops at a place along its path and stays there, as a
/// movement authority demands.
///
/// The speed from which a vehicle stops within `left` metres if it begins to brake `reaction_s`
/// late is v = sqrt((a t)^2 + 2 a left) - a t: constant braking that ends in an exponential
/// approach with time constant t. So lags of wheels and estimates do not carry the vehicle beyond.
/// The profile aims slightly short of the place. A stopped vehicle stays until the place has moved
/// on by more than the noise of an estimate, so that it does not creep.

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/path.h"
#include "engine/api/signal.h"

namespace vinerow::controllers {

class StopProfile {
 public:
  static constexpr double kShort_m = 0.1;    ///< distance of the aim before the place
  static constexpr double kThere_m = 0.02;   ///< nearer to the aim than this: stop
  static constexpr double kResume_m = 0.15;  ///< farther from the aim than this: drive again
  static constexpr double kReaction_s = 0.3;

  /// @param deceleration_mps2  > 0
  explicit StopProfile(double deceleration_mps2) : deceleration_mps2_(deceleration_mps2) {}

  /// @param stop_at_m  along the path; +infinity: none
  void set_place(double stop_at_m) { stop_at_m_ = stop_at_m; }
  /// Another path: the vehicle is no longer held.
  void reset() { is_holding_ = false; }

  /// Once per cycle. @returns the largest forward speed, m/s; 0: stop; +infinity without a place
  double update(double distance_m) {
    left_m_ = stop_at_m_ - kShort_m - distance_m;
    is_holding_ = left_m_ <= (is_holding_ ? kResume_m : kThere_m);
    if (is_holding_) return 0.0;
    const double late_mps = deceleration_mps2_ * kReaction_s;
    return std::sqrt(late_mps * late_mps + 2.0 * deceleration_mps2_ * left_m_) - late_mps;
  }

  /// As of the last update().
  bool is_holding() const { return is_holding_; }
  /// Distance to the aim, m; not negative.
  double left_m() const { return std::max(left_m_, 0.0); }

 private:
  double deceleration_mps2_;
  double stop_at_m_ = std::numeric_limits<double>::infinity();
  double left_m_ = std::numeric_limits<double>::infinity();
  bool is_holding_ = false;
};

/// End of a vehicle's movement authority from the optional signal "authority"; +infinity if the
/// signal is not written.
inline double read_stop_at_m(const SignalReader<MovementAuthority>& authority) {
  return authority.has_value() ? authority.value().stop_at_m
                               : std::numeric_limits<double>::infinity();
}

}  // namespace vinerow::controllers
