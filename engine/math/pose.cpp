#include "engine/math/pose.h"

#include <cmath>

namespace vinerow {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond quaternion_from_rpy(const RollPitchYaw& rpy) {
  return AngleAxisd(rpy.yaw_rad, Vector3d::UnitZ()) * AngleAxisd(rpy.pitch_rad, Vector3d::UnitY()) *
         AngleAxisd(rpy.roll_rad, Vector3d::UnitX());
}

RollPitchYaw rpy_from_quaternion(const Quaterniond& q) {
  const Matrix3d R = q.toRotationMatrix();
  const double sin_pitch = -R(2, 0);
  if (std::abs(sin_pitch) > 1.0 - 1e-12) {
    return {0.0, std::copysign(std::asin(1.0), sin_pitch), std::atan2(-R(0, 1), R(1, 1))};
  }
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(sin_pitch), std::atan2(R(1, 0), R(0, 0))};
}

double yaw_from_quaternion(const Quaterniond& q) {
  const Vector3d x_W = q * Vector3d::UnitX();
  return std::atan2(x_W.y(), x_W.x());
}

Quaterniond quaternion_on_slope(double yaw_rad, const Vector3d& normal_W) {
  const Vector3d z = normal_W.normalized();
  // The x axis is the intersection of the slope with the vertical plane of the heading.
  const Vector3d heading(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  const Vector3d x = (heading - Vector3d(0.0, 0.0, heading.dot(z) / z.z())).normalized();
  Matrix3d R;
  R.col(0) = x;
  R.col(1) = z.cross(x);
  R.col(2) = z;
  return Quaterniond(R);
}

}  // namespace vinerow
