#pragma once
/// Tells when the vehicle leaves the limits of its states, and when it is back: once each.

#include <string>

#include "controllers/quadrotor_mpc/quadrotor_mpc_params.h"

namespace vinerow::controllers {

/// What the limits are about, now.
struct FlightDeviation {
  double tilt_rad = 0.0, lateral_m = 0.0, altitude_m = 0.0, speed_mps = 0.0;
};

class LimitWatch {
 public:
  enum class News { kNone, kLeft, kBack };

  explicit LimitWatch(const MpcLimits& limits) : limits_(limits) {}

  /// Back is who keeps to 90 % of every limit, so that noise at a limit is one occurrence.
  News update(const FlightDeviation& deviation, double now_s);
  bool is_outside() const { return is_outside_; }
  void reset() { is_outside_ = false; }

  /// "tilt 31.2 deg of 25, lateral 2.00 m of 0.25" @pre the last update() said kLeft
  std::string describe(const FlightDeviation& deviation) const;
  /// Time that the last stay outside took. @pre the last update() said kBack
  double outside_s() const { return outside_s_; }

 private:
  bool keeps(const FlightDeviation& deviation, double share) const;

  MpcLimits limits_;
  bool is_outside_ = false;
  double left_at_s_ = 0.0, outside_s_ = 0.0;
};

}  // namespace vinerow::controllers
