#pragma once
/// Poses and rotations in monogram notation: X_AB is the pose of B in A, R_AB rotates vectors from
/// B to A.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vinerow {

/// Rigid transform X_AB.
struct Pose {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< R_AB, unit
  Eigen::Vector3d p = Eigen::Vector3d::Zero();            ///< origin of B in A, m

  /// Point of B expressed in A.
  Eigen::Vector3d operator*(const Eigen::Vector3d& p_B) const { return q * p_B + p; }
  /// X_AC = X_AB * X_BC.
  Pose operator*(const Pose& X_BC) const { return {q * X_BC.q, q * X_BC.p + p}; }
  Pose inverse() const {
    const Eigen::Quaterniond q_inverse = q.conjugate();
    return {q_inverse, -(q_inverse * p)};
  }
};

/// Roll about x, then pitch about y, then yaw about z of fixed axes: R = Rz(yaw) Ry(pitch)
/// Rx(roll). With z up a positive pitch lowers the nose.
struct RollPitchYaw {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};

Eigen::Quaterniond quaternion_from_rpy(const RollPitchYaw& rpy);

/// Inverse of quaternion_from_rpy; at |pitch| = 90 deg the roll is returned as zero.
RollPitchYaw rpy_from_quaternion(const Eigen::Quaterniond& q);

/// Heading of the body's x axis in the horizontal plane, rad in (-pi, pi].
double yaw_from_quaternion(const Eigen::Quaterniond& q);

/// Attitude of a vehicle on a slope: z along the normal, x uphill or downhill of the desired
/// heading.
/// @param normal_W  upward, any length > 0
Eigen::Quaterniond quaternion_on_slope(double yaw_rad, const Eigen::Vector3d& normal_W);

}  // namespace vinerow
