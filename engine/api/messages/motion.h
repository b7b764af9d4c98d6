#pragma once
/// Motion messages: pose and twist of a body, poses of its links, and sets that contain a position.
/// Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "engine/api/field.h"
#include "engine/math/pose.h"

namespace vinerow {

/// Symmetric matrix from its diagonal and the elements above it (xy, xz, yz).
inline Eigen::Matrix3d symmetric_matrix(const Eigen::Vector3d& diagonal,
                                        const Eigen::Vector3d& off_diagonal) {
  Eigen::Matrix3d m = diagonal.asDiagonal();
  m(0, 1) = m(1, 0) = off_diagonal.x();
  m(0, 2) = m(2, 0) = off_diagonal.y();
  m(1, 2) = m(2, 1) = off_diagonal.z();
  return m;
}

/// Pose and twist of a body; truth or estimate. ROS 2: nav_msgs/msg/Odometry.
struct Odometry {
  static constexpr const char* kType = "Odometry";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  Pose X_WB;
  Eigen::Vector3d v_WB_B = Eigen::Vector3d::Zero();  ///< velocity of B's origin, m/s, in B
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();  ///< angular velocity, rad/s, in B
  /// Covariance of the position error in W: variances (xx, yy, zz) and covariances (xy, xz, yz),
  /// m2; zero for truth.
  Eigen::Vector3d position_variance_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_covariance_m2 = Eigen::Vector3d::Zero();
  double yaw_std_rad = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"pose", "", "of the body"}, self.X_WB);
    f({"linear_velocity", "m/s", "of the body's origin, in the body"}, self.v_WB_B);
    f({"angular_velocity", "rad/s", "in the body"}, self.w_WB_B);
    f({"position_variance", "m^2", "xx, yy, zz; 0 for truth"}, self.position_variance_m2);
    f({"position_covariance", "m^2", "xy, xz, yz"}, self.position_covariance_m2);
    f({"yaw_std", "rad"}, self.yaw_std_rad);
  }

  /// Variances and covariances as one symmetric matrix.
  Eigen::Matrix3d position_covariance() const {
    return symmetric_matrix(position_variance_m2, position_covariance_m2);
  }
  void set_position_covariance(const Eigen::Matrix3d& covariance_m2) {
    position_variance_m2 = covariance_m2.diagonal();
    position_covariance_m2 = {covariance_m2(0, 1), covariance_m2(0, 2), covariance_m2(1, 2)};
  }
};

/// Pose and twist of a body by dead reckoning: in a frame O that stays where the body's frame was
/// at the start but drifts with the errors (frame "odom" of ROS REP 105). ROS 2:
/// nav_msgs/msg/Odometry.
struct DeadReckoning {
  static constexpr const char* kType = "DeadReckoning";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  Pose X_OB;
  Eigen::Vector3d v_OB_B = Eigen::Vector3d::Zero();  ///< velocity of B's origin, m/s, in B
  Eigen::Vector3d w_OB_B = Eigen::Vector3d::Zero();  ///< angular velocity, rad/s, in B
  /// Standard deviations of this reading's velocity, in B, and of its yaw rate; zero for truth.
  Eigen::Vector3d velocity_std_mps = Eigen::Vector3d::Zero();
  double yaw_rate_std_radps = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"pose", "", "of the body, in the frame of its start"}, self.X_OB);
    f({"linear_velocity", "m/s", "of the body's origin, in the body"}, self.v_OB_B);
    f({"angular_velocity", "rad/s", "in the body"}, self.w_OB_B);
    f({"velocity_std", "m/s", "in the body; 0 for truth"}, self.velocity_std_mps);
    f({"yaw_rate_std", "rad/s"}, self.yaw_rate_std_radps);
  }
};

/// Pose that a body should reach: a goal. ROS 2: geometry_msgs/msg/PoseStamped.
struct PoseTarget {
  static constexpr const char* kType = "PoseTarget";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  Pose X_WB;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"pose", "", "of the body"}, self.X_WB);
  }
};

/// Ellipsoid that should contain the true position: (p - c)' P^-1 (p - c) <= 1. ROS 2:
/// geometry_msgs/msg/PoseWithCovarianceStamped.
struct PositionEllipsoid {
  static constexpr const char* kType = "PositionEllipsoid";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  /// P in W: diagonal (xx, yy, zz) and off-diagonal elements (xy, xz, yz), m2.
  Eigen::Vector3d shape_diagonal_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d shape_beside_m2 = Eigen::Vector3d::Zero();

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"centre", "m"}, self.centre_W);
    f({"shape_diagonal", "m^2", "xx, yy, zz"}, self.shape_diagonal_m2);
    f({"shape_beside", "m^2", "xy, xz, yz"}, self.shape_beside_m2);
  }
};

/// Poses of the moving links of a vehicle in W, for pictures and /tf. ROS 2:
/// tf2_msgs/msg/TFMessage.
struct LinkPoses {
  static constexpr const char* kType = "LinkPoses";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  std::vector<std::string> names;
  std::vector<Pose> X_WL;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"names"}, self.names);
    f({"poses"}, self.X_WL);
  }
};

}  // namespace vinerow
