#include "controllers/estimation/inertial/error_state.h"

#include <cmath>

namespace vinerow::controllers {

bool NavState::is_finite() const {
  return p_WI.allFinite() && v_WI.allFinite() && q_WB.coeffs().allFinite() &&
         gyro_bias_B.allFinite() && accel_bias_B.allFinite();
}

NavState NavState::plus(const ErrorVector& dx) const {
  using I = ErrorIndex;
  NavState result;
  result.p_WI = p_WI + dx.segment<3>(I::kPosition);
  result.v_WI = v_WI + dx.segment<3>(I::kVelocity);
  result.q_WB = (exp_rotation(dx.segment<3>(I::kAttitude)) * q_WB).normalized();
  result.gyro_bias_B = gyro_bias_B + dx.segment<3>(I::kGyroBias);
  result.accel_bias_B = accel_bias_B + dx.segment<3>(I::kAccelBias);
  return result;
}

ErrorVector NavState::minus(const NavState& nominal) const {
  ErrorVector dx;
  dx << p_WI - nominal.p_WI, v_WI - nominal.v_WI, log_rotation(q_WB * nominal.q_WB.conjugate()),
      gyro_bias_B - nominal.gyro_bias_B, accel_bias_B - nominal.accel_bias_B;
  return dx;
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond exp_rotation(const Eigen::Vector3d& angle_rad) {
  const double angle = angle_rad.norm();
  // sin(x/2)/x by its series if the quotient would be 0/0; the next term is below 1e-18.
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  const Eigen::Vector3d v = factor * angle_rad;
  return {std::cos(0.5 * angle), v.x(), v.y(), v.z()};
}

Eigen::Vector3d log_rotation(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  const double angle = 2.0 * std::atan2(sine, sign * q.w());
  return (sine < 1e-12 ? 2.0 : angle / sine) * sign * q.vec();
}

ErrorTransition::ErrorTransition(const Eigen::Matrix3d& R_WB, const Eigen::Vector3d& f_W,
                                 double dt_s)
    : dt_s_(dt_s) {
  // Sola section 7.2: dv' = -[R f]x dtheta - R dba, dtheta' = -R dbg, dp' = dv.
  const Eigen::Matrix3d force = skew(f_W);
  att_gyro_ = -dt_s * R_WB;
  vel_att_ = -dt_s * force;
  vel_accel_ = -dt_s * R_WB;
  pos_att_ = 0.5 * dt_s * vel_att_;
  pos_accel_ = 0.5 * dt_s * vel_accel_;
  vel_gyro_ = (0.5 * dt_s * dt_s) * force * R_WB;
  pos_gyro_ = (dt_s / 3.0) * vel_gyro_;
}

void ErrorTransition::propagate(ErrorCovariance& P) const {
  apply_left(P);
  P.transposeInPlace();
  apply_left(P);
  P = (0.5 * (P + P.transpose())).eval();
}

ErrorCovariance ErrorTransition::matrix() const {
  ErrorCovariance F = ErrorCovariance::Identity();
  apply_left(F);
  return F;
}

}  // namespace vinerow::controllers
