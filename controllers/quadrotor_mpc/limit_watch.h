#pragma once
/// Detects when the vehicle leaves the limits of its states, and when it returns: one event each.

#include <string>

#include "controllers/quadrotor_mpc/quadrotor_mpc_params.h"

namespace vinerow::controllers {

/// Current values of the limited quantities.
struct FlightDeviation {
  double tilt_rad = 0.0, lateral_m = 0.0, altitude_m = 0.0, speed_mps = 0.0;
};

class LimitWatch {
 public:
  enum class PendingEvent { kNone, kLeft, kBack };

  explicit LimitWatch(const MpcLimits& limits) : limits_(limits) {}

  /// It has returned when it keeps 90 % of every limit, so that noise at a limit is one occurrence.
  PendingEvent update(const FlightDeviation& deviation, double now_s);
  bool is_outside() const { return is_outside_; }
  void reset() { is_outside_ = false; }

  /// "tilt 31.2 deg of 25, lateral 2.00 m of 0.25" @pre the last update() returned kLeft
  std::string describe(const FlightDeviation& deviation) const;
  /// Duration of the last stay outside. @pre the last update() returned kBack
  double outside_s() const { return outside_s_; }

 private:
  bool keeps(const FlightDeviation& deviation, double share) const;

  MpcLimits limits_;
  bool is_outside_ = false;
  double left_at_s_ = 0.0, outside_s_ = 0.0;
};

}  // namespace vinerow::controllers
