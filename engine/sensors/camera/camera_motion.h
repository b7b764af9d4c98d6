#pragma once
/// Where a camera is while it reads a picture out.

#include <Eigen/Core>

#include "engine/api/messages/motion.h"
#include "engine/math/pose.h"

namespace vinerow::sensors {

/// The optical frame (x right, y down, z along the axis) in S (x along the axis, y left, z up).
const Eigen::Matrix3d& R_SC();

/// Place of the optical frame.
struct OpticalPlace {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WC = Eigen::Matrix3d::Identity();
};

/// Pose of S at the stamp, and how it moves: evenly, also while it turns.
struct CameraMotion {
  Pose X_WS;
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();     ///< m/s
  Eigen::Vector3d w_WS_S = Eigen::Vector3d::Zero();  ///< rad/s

  /// @param body  of the vehicle at the stamp  @param X_BS  mounting
  static CameraMotion of_body(const Odometry& body, const Pose& X_BS);
  /// @param time_s  after the stamp
  OpticalPlace place_at(double time_s) const;
};

/// When a row is exposed, after the stamp: rows are read evenly, from the first to the last in
/// readout_s, the middle one at the stamp.
/// @param row  of `height`, also between two
double row_time_s(double row, int height, double readout_s);

}  // namespace vinerow::sensors
