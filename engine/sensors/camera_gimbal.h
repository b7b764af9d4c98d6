#pragma once
/// Two-axis stabilised mount: compensates a vehicle's roll and pitch within its angle limit and
/// lag. Yaw follows the vehicle.
///
/// Outer axis: roll, along x of B; inner axis: pitch. With the vehicle's attitude Rz Ry Rx the
/// mount has Rz(yaw) Ry(pitch) Rx(roll - g_r) Ry(-g_p), which is level if the gimbal's angles g
/// equal the vehicle's. They follow these through a first-order lag T. The residual r of an angle a
/// obeys r' = a' - r / T: it is T a' at a steady rate, and w T / sqrt(1 + (w T)^2) of an
/// oscillation at w. Between two ticks angles are taken to change linearly, for which the lag is
/// exact. Beyond the limit the residual is the rest of the angle.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "engine/math/pose.h"

namespace vinerow::sensors {

class CameraGimbal {
 public:
  CameraGimbal() = default;
  /// @param limit_rad  of each angle, to both sides
  /// @param lag_s  >= 0; 0: no lag
  CameraGimbal(double limit_rad, double lag_s) : limit_rad_(limit_rad), lag_s_(lag_s) {}

  /// Advances to the vehicle's current attitude; the first call starts without lag.
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
    double rest_rad = 0.0;   ///< residual that the gimbal has not compensated
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
