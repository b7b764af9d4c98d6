#pragma once
/// State of a vehicle in the frames of autopilots: north, east, down (NED) and forward, right, down
/// (FRD), instead of east, north, up (W) and forward, left, up (B).

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace vinerow::controllers {

/// (east, north, up) to (north, east, down), and back: its own inverse.
inline Eigen::Vector3d swap_ned_and_W(const Eigen::Vector3d& v) {
  return {v.y(), v.x(), -v.z()};
}

/// (forward, left, up) to (forward, right, down), and back: its own inverse.
inline Eigen::Vector3d swap_frd_and_B(const Eigen::Vector3d& v) {
  return {v.x(), -v.y(), -v.z()};
}

/// Half a turn about the horizontal line north-east: from W to NED and back.
inline Eigen::Quaterniond q_NED_W() {
  return {0.0, std::sqrt(0.5), std::sqrt(0.5), 0.0};
}
/// Half a turn about the forward axis: from FRD to B and back.
inline Eigen::Quaterniond q_B_FRD() {
  return {0.0, 1.0, 0.0, 0.0};
}

/// Rotation from FRD to NED of a body with the rotation q_WB: R_NED_W R_WB R_B_FRD.
inline Eigen::Quaterniond q_NED_FRD_from(const Eigen::Quaterniond& q_WB) {
  return q_NED_W() * q_WB * q_B_FRD();
}

/// The inverse: q_WB of a body with roll, pitch and yaw of FRD in NED, rad.
inline Eigen::Quaterniond q_WB_from_ned(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Quaterniond q_NED_FRD = AngleAxisd(yaw, Vector3d::UnitZ()) *
                                       AngleAxisd(pitch, Vector3d::UnitY()) *
                                       AngleAxisd(roll, Vector3d::UnitX());
  return q_NED_W().conjugate() * q_NED_FRD * q_B_FRD().conjugate();
}

}  // namespace vinerow::controllers
