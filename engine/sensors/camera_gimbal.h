#pragma once
/// A stabilised mount of two axes: takes a vehicle's roll and pitch out of what hangs on it, as far
/// as it can turn and as fast as it can follow. Yaw is the vehicle's.
///
/// Outer axis: roll, along x of B; inner axis: pitch. With the vehicle's attitude Rz Ry Rx the
/// mount has Rz(yaw) Ry(pitch) Rx(roll - g_r) Ry(-g_p), which is level where the gimbal's angles g
/// are the vehicle's. They follow these through a first-order lag T: what remains of an angle a is
/// r with r' = a' - r / T, so T a' of a steady rate and w T / sqrt(1 + (w T)^2) of a swing at w.
/// Between two ticks angles count as changing evenly, for which the lag is exact. Beyond the limit
/// the rest remains.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "engine/math/pose.h"

namespace vinerow::sensors {

class CameraGimbal {
 public:
  CameraGimbal() = default;
  /// @param limit_rad  each angle's, to both sides  @param lag_s  >= 0; 0 follows at once
  CameraGimbal(double limit_rad, double lag_s) : limit_rad_(limit_rad), lag_s_(lag_s) {}

  /// To the vehicle's attitude now; the first call begins without any lag.
  /// @param dt_s  since the last call
  /// @returns the mount's attitude in W
  Eigen::Quaterniond advance(double dt_s, const Eigen::Quaterniond& q_WB) {
    const RollPitchYaw rpy = rpy_from_quaternion(q_WB);
    follow(rpy.roll_rad, dt_s, roll_);
    follow(rpy.pitch_rad, dt_s, pitch_);
    has_begun_ = true;
    return q_WB * Eigen::AngleAxisd(-(roll_.angle_rad - roll_.rest_rad), Eigen::Vector3d::UnitX()) *
           Eigen::AngleAxisd(-(pitch_.angle_rad - pitch_.rest_rad), Eigen::Vector3d::UnitY());
  }

 private:
  struct Axis {
    double angle_rad = 0.0;  ///< the vehicle's
    double rest_rad = 0.0;   ///< what the gimbal has not taken out of it
  };

  void follow(double angle_rad, double dt_s, Axis& axis) const {
    const double change_rad = wrap_angle(angle_rad - axis.angle_rad);
    double rest_rad = 0.0;
    if (has_begun_ && lag_s_ > 0.0 && dt_s > 0.0) {
      const double kept = std::exp(-dt_s / lag_s_);
      rest_rad = kept * axis.rest_rad + (1.0 - kept) * lag_s_ / dt_s * change_rad;
    }
    axis.angle_rad = angle_rad;
    axis.rest_rad = angle_rad - std::clamp(angle_rad - rest_rad, -limit_rad_, limit_rad_);
  }

  double limit_rad_ = 0.0;
  double lag_s_ = 0.0;
  bool has_begun_ = false;
  Axis roll_, pitch_;
};

}  // namespace vinerow::sensors
