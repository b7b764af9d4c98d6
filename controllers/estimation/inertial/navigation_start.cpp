#include "controllers/estimation/inertial/navigation_start.h"

#include <cmath>

#include "engine/api/messages/motion.h"
#include "engine/core/constants.h"
#include "engine/math/angles.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

ErrorCovariance start_covariance(const ErrorStateOptions& options) {
  ErrorVector std;
  std.segment<3>(ErrorIndex::kPosition) << options.start_std_m, options.start_std_m,
      options.start_height_std_m;
  std.segment<3>(ErrorIndex::kVelocity).setConstant(options.start_velocity_std_mps);
  std.segment<3>(ErrorIndex::kAttitude) << options.start_tilt_std_rad, options.start_tilt_std_rad,
      options.start_yaw_std_rad;
  std.segment<3>(ErrorIndex::kGyroBias).setConstant(options.gyro_bias_std_radps);
  std.segment<3>(ErrorIndex::kAccelBias).setConstant(options.accel_bias_std_mps2);
  return std.cwiseAbs2().asDiagonal();
}

NavState draw_start(const Odometry& truth, const Eigen::Vector3d& p_BI,
                    const ErrorCovariance& covariance, RandomStream& random) {
  NavState state;
  state.p_WI = truth.X_WB * p_BI;
  state.v_WI = truth.X_WB.q * (truth.v_WB_B + truth.w_WB_B.cross(p_BI));
  state.q_WB = truth.X_WB.q;
  ErrorVector dx = ErrorVector::Zero();
  for (int i = 0; i < ErrorIndex::kGyroBias; ++i) {
    dx[i] = std::sqrt(covariance(i, i)) * random.normal();
  }
  return state.plus(dx);
}

NavStart moved_start(const NavState& present, const ErrorCovariance& covariance,
                     const InitialPose::Value& pose, const Eigen::Vector3d& p_BI) {
  const double turn_rad = pose.yaw_rad - yaw_from_quaternion(present.q_WB);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()));
  NavStart start{present, ErrorCovariance::Zero()};
  start.state.q_WB = (turn * present.q_WB).normalized();
  start.state.v_WI = turn * present.v_WI;
  const double height_m = present.p_WI.z();
  start.state.p_WI.head<2>() = pose.p_W + (start.state.q_WB * p_BI).head<2>();
  start.state.p_WI.z() = height_m;
  // Correlations with the old place mean nothing at the new one.
  start.covariance.diagonal() = covariance.diagonal();
  start.covariance.diagonal().segment<2>(ErrorIndex::kPosition) = pose.std_m.cwiseAbs2();
  start.covariance(ErrorIndex::kAttitude + 2, ErrorIndex::kAttitude + 2) =
      pose.yaw_std_rad * pose.yaw_std_rad;
  return start;
}

Eigen::Quaterniond level_attitude(const Eigen::Vector3d& f_B, double yaw_rad) {
  const double roll = std::atan2(f_B.y(), f_B.z());
  const double pitch = std::atan2(-f_B.x(), std::hypot(f_B.y(), f_B.z()));
  return quaternion_from_rpy({roll, pitch, yaw_rad});
}

double heading_from_field(const Eigen::Vector3d& f_B, const Eigen::Vector3d& field_B,
                          double north_rad) {
  const Eigen::Vector3d field = level_attitude(f_B, 0.0) * field_B;
  return wrap_angle(north_rad - std::atan2(field.y(), field.x()));
}

double standard_height_m(double pressure_Pa) {
  constexpr double kExponent = 0.0065 * 287.05287 / kStandardGravity_mps2;
  return 288.15 / 0.0065 * (1.0 - std::pow(pressure_Pa / 101'325.0, kExponent));
}

}  // namespace vinerow::controllers
