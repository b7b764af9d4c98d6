#include "controllers/quadrotor_pid/attitude_law.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

/// The shortest turn from the z axis of q_WB to that of `wanted`, in B. Opposite axes: about x.
Eigen::Quaterniond calc_tilt_turn(const Eigen::Quaterniond& q_WB,
                                  const Eigen::Quaterniond& wanted) {
  const Eigen::Vector3d z_B = q_WB.conjugate() * (wanted * Eigen::Vector3d::UnitZ());
  constexpr double kOpposite = 1e-9;
  const double half = 1.0 + z_B.z();
  if (half < kOpposite) return {0.0, 1.0, 0.0, 0.0};
  return Eigen::Quaterniond(half, -z_B.y(), z_B.x(), 0.0).normalized();
}

}  // namespace

Eigen::Quaterniond calc_wanted_attitude(const Eigen::Vector3d& F_W, double yaw_rad) {
  const Eigen::Vector3d z = F_W.normalized();
  const Eigen::Vector3d y_of_heading(-std::sin(yaw_rad), std::cos(yaw_rad), 0.0);
  const Eigen::Vector3d x = y_of_heading.cross(z).normalized();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return Eigen::Quaterniond(R);
}

Eigen::Vector3d calc_wanted_rates(const Eigen::Quaterniond& q_WB, const Eigen::Quaterniond& wanted,
                                  double yaw_rate_radps, const AttitudeParams& params) {
  const Eigen::Quaterniond tilt = calc_tilt_turn(q_WB, wanted);
  // The remainder after the tilt is a rotation about the thrust: q_WB tilt yaw = wanted.
  const Eigen::Quaterniond yaw = (q_WB * tilt).conjugate() * wanted;
  const double tilt_rad = 2.0 * std::atan2(tilt.vec().norm(), tilt.w());
  double yaw_rad = 2.0 * std::atan2(yaw.z(), yaw.w());
  yaw_rad = std::remainder(yaw_rad, 2.0 * M_PI);

  const double speed = std::min(params.tilt_p_per_s * tilt_rad, params.tilt_rate_limit_radps);
  const double length = tilt.vec().norm();
  Eigen::Vector3d rates = Eigen::Vector3d::Zero();
  if (length > 0.0) rates = tilt.vec() * (speed / length);
  // The reference turns about the vertical.
  const double yaw_speed = std::clamp(params.yaw_p_per_s * yaw_rad, -params.yaw_rate_limit_radps,
                                      params.yaw_rate_limit_radps);
  rates.z() += yaw_speed;
  rates += q_WB.conjugate() * Eigen::Vector3d(0.0, 0.0, yaw_rate_radps);
  return rates;
}

}  // namespace vinerow::controllers
