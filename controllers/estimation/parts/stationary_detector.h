#pragma once
/// Detector of a stationary ground vehicle.

#include <Eigen/Core>
#include <cmath>

#include "engine/core/time.h"

namespace vinerow::controllers {

/// Stationary means quiet for a given time; every sign of motion restarts the clock.
class StationaryDetector {
 public:
  /// Limits below which wheels (rim speed) and an IMU (angular rate, deviation of |f| from gravity)
  /// are quiet. Those of the IMU are about five times a consumer unit's noise per sample.
  static constexpr double kWheel_mps = 0.01;
  static constexpr double kRate_radps = 0.02;
  static constexpr double kForce_mps2 = 0.15;
  /// A steady drive is as quiet as a stop, so the IMU counts only if the estimated speed is below
  /// this.
  static constexpr double kSpeed_mps = 0.2;

  explicit StationaryDetector(double quiet_s) : quiet_s_(quiet_s) {}

  void see_wheels(Time now, double speed_mps) { see(now, std::abs(speed_mps) < kWheel_mps); }
  /// @param w_B  without bias  @param speed_mps  of the estimate
  void see_imu(Time now, const Eigen::Vector3d& w_B, const Eigen::Vector3d& f_B, double speed_mps,
               double gravity_mps2) {
    see(now, w_B.norm() < kRate_radps && std::abs(f_B.norm() - gravity_mps2) < kForce_mps2 &&
                 speed_mps < kSpeed_mps);
  }
  bool stands(Time now) const { return is_quiet_ && (now - since_).s() >= quiet_s_; }

 private:
  void see(Time now, bool quiet) {
    if (quiet && !is_quiet_) since_ = now;
    is_quiet_ = quiet;
  }
  double quiet_s_;
  bool is_quiet_ = false;
  Time since_;
};

}  // namespace vinerow::controllers
