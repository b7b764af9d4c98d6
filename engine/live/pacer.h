#pragma once
/// Holds a run to a speed: simulated seconds per second of wall time.

#include <chrono>
#include <optional>
#include <string>

#include "engine/core/time.h"

namespace vinerow::live {

/// Not thread-safe.
class Pacer {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param speed  0 = as fast as possible
  void set_speed(double speed) {
    speed_ = speed;
    rebase();
  }
  double speed() const { return speed_; }
  /// Forgets the past: after a pause, a wait, a restart.
  void rebase() { base_.reset(); }

  struct Plan {
    /// Wall time to wait before the next slice; 0: it may begin.
    Clock::duration wait{};
    Duration slice;  ///< its length
  };
  /// @param now  next instant. @param longest  of the slice
  Plan plan(Time now, Clock::time_point wall, Duration longest);
  /// A sentence when the speed cannot be held, at most every 10 s of wall time; otherwise "".
  std::string take_lag();

  /// Measured speed over about the last second. Call once per slice.
  double measure(Time now, Clock::time_point wall);

 private:
  struct Moment {
    Clock::time_point wall;
    Time simulated;
  };
  double speed_ = 0.0;
  std::optional<Moment> base_;
  std::optional<Moment> last_slice_;
  Duration slice_{1'000'000};
  std::optional<Moment> measured_from_;
  double factor_ = 0.0;
  double lag_s_ = 0.0;
  std::optional<Clock::time_point> last_words_;
};

}  // namespace vinerow::live
