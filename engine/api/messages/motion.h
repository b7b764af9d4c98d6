#pragma once
/// Messages about motion: pose and twist of a body, of its links, and sets that contain a position.
/// Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "engine/math/pose.h"

namespace vinerow {

/// A symmetric matrix by its diagonal and what is above it (xy, xz, yz).
inline Eigen::Matrix3d symmetric_matrix(const Eigen::Vector3d& diagonal,
                                        const Eigen::Vector3d& beside) {
  Eigen::Matrix3d m = diagonal.asDiagonal();
  m(0, 1) = m(1, 0) = beside.x();
  m(0, 2) = m(2, 0) = beside.y();
  m(1, 2) = m(2, 1) = beside.z();
  return m;
}

/// Pose and twist of a body; truth or estimate. ROS 2: nav_msgs/msg/Odometry.
struct Odometry {
  static constexpr const char* kType = "Odometry";
  Pose X_WB;
  Eigen::Vector3d v_WB_B = Eigen::Vector3d::Zero();  ///< velocity of B's origin, m/s, in B
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();  ///< angular velocity, rad/s, in B
  /// Of the position's error in W: variances (xx, yy, zz) and covariances (xy, xz, yz), m2; zero
  /// for truth.
  Eigen::Vector3d position_variance_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_covariance_m2 = Eigen::Vector3d::Zero();
  double yaw_std_rad = 0.0;

  template <class F>
  void fields(F&& f) {
    f(X_WB.p), f(X_WB.q), f(v_WB_B), f(w_WB_B), f(position_variance_m2);
    f(position_covariance_m2), f(yaw_std_rad);
  }

  /// Both as one symmetric matrix.
  Eigen::Matrix3d position_covariance() const {
    return symmetric_matrix(position_variance_m2, position_covariance_m2);
  }
  void set_position_covariance(const Eigen::Matrix3d& covariance_m2) {
    position_variance_m2 = covariance_m2.diagonal();
    position_covariance_m2 = {covariance_m2(0, 1), covariance_m2(0, 2), covariance_m2(1, 2)};
  }
};

/// A set that is to contain the true position: (p - c)' P^-1 (p - c) <= 1. ROS 2:
/// geometry_msgs/msg/PoseWithCovarianceStamped.
struct PositionEllipsoid {
  static constexpr const char* kType = "PositionEllipsoid";
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  /// P in W: diagonal (xx, yy, zz) and what is beside it (xy, xz, yz), m2.
  Eigen::Vector3d shape_diagonal_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d shape_beside_m2 = Eigen::Vector3d::Zero();

  template <class F>
  void fields(F&& f) {
    f(centre_W), f(shape_diagonal_m2), f(shape_beside_m2);
  }
};

/// Poses of the moving links of a vehicle in W, for pictures and /tf. ROS 2:
/// tf2_msgs/msg/TFMessage.
struct LinkPoses {
  static constexpr const char* kType = "LinkPoses";
  std::vector<std::string> names;
  std::vector<Pose> X_WL;

  template <class F>
  void fields(F&& f) {
    f(names);
    for (Pose& pose : X_WL) f(pose.p), f(pose.q);
  }
};

}  // namespace vinerow
