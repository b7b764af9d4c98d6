#pragma once
/// Error state of strapdown navigation: the fifteen errors, their order, and their transition over
/// a time step.
///
/// Source: J. Sola, "Quaternion kinematics for the error-state Kalman filter", 2017
/// (arXiv:1711.02508): section 5.3 for the kinematics, section 7 for the attitude error in W, which
/// is used here: R_true = Exp(dtheta) R. Its third component is therefore a rotation about the
/// vertical.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vinerow::controllers {

/// First index of each block of three: position, velocity, attitude, gyro bias, accelerometer bias.
struct ErrorIndex {
  static constexpr int kPosition = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kAttitude = 6;
  static constexpr int kGyroBias = 9;
  static constexpr int kAccelBias = 12;
  static constexpr int kCount = 15;
};

using ErrorVector = Eigen::Matrix<double, ErrorIndex::kCount, 1>;
using ErrorRow = Eigen::Matrix<double, 1, ErrorIndex::kCount>;
using ErrorCovariance = Eigen::Matrix<double, ErrorIndex::kCount, ErrorIndex::kCount>;

/// Nominal state. I is the inertial unit's origin; the axes are the body's.
struct NavState {
  Eigen::Vector3d p_WI = Eigen::Vector3d::Zero();            ///< m
  Eigen::Vector3d v_WI = Eigen::Vector3d::Zero();            ///< m/s, in W
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  ///< unit
  Eigen::Vector3d gyro_bias_B = Eigen::Vector3d::Zero();     ///< rad/s
  Eigen::Vector3d accel_bias_B = Eigen::Vector3d::Zero();    ///< m/s2

  bool is_finite() const;
  /// The true state whose error is dx (injection, Sola eq. 283, with section 7's attitude).
  NavState plus(const ErrorVector& dx) const;
  /// dx with this->plus(dx) = other.
  ErrorVector minus(const NavState& nominal) const;
};

/// [v]x: skew(v) w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);
/// Unit quaternion of a rotation vector, rad (Sola eq. 101).
Eigen::Quaterniond exp_rotation(const Eigen::Vector3d& angle_rad);
/// Rotation vector of a unit quaternion, |angle| <= pi (Sola eq. 103).
Eigen::Vector3d log_rotation(const Eigen::Quaterniond& q);

/// Transition of the errors over dt under constant specific force and attitude. With A of Sola's
/// section 7.2 (A^4 = 0) this is exp(A dt) exactly, not its first order. dt may be negative.
class ErrorTransition {
 public:
  /// @param f_W  specific force in W, m/s2
  ErrorTransition(const Eigen::Matrix3d& R_WB, const Eigen::Vector3d& f_W, double dt_s);

  /// M <- F M, in place.
  template <class Matrix>
  void apply_left(Matrix& M) const {
    using I = ErrorIndex;
    M.template middleRows<3>(I::kPosition) += dt_s_ * M.template middleRows<3>(I::kVelocity) +
                                              pos_att_ * M.template middleRows<3>(I::kAttitude) +
                                              pos_gyro_ * M.template middleRows<3>(I::kGyroBias) +
                                              pos_accel_ * M.template middleRows<3>(I::kAccelBias);
    M.template middleRows<3>(I::kVelocity) += vel_att_ * M.template middleRows<3>(I::kAttitude) +
                                              vel_gyro_ * M.template middleRows<3>(I::kGyroBias) +
                                              vel_accel_ * M.template middleRows<3>(I::kAccelBias);
    M.template middleRows<3>(I::kAttitude) += att_gyro_ * M.template middleRows<3>(I::kGyroBias);
  }
  /// P <- F P F'. @pre P symmetric
  void propagate(ErrorCovariance& P) const;
  ErrorCovariance matrix() const;

 private:
  double dt_s_;
  Eigen::Matrix3d pos_att_, pos_gyro_, pos_accel_, vel_att_, vel_gyro_, vel_accel_, att_gyro_;
};

}  // namespace vinerow::controllers
