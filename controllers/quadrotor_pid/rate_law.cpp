#include "controllers/quadrotor_pid/rate_law.h"

#include <cmath>

#include "controllers/quadrotor_pid/axis_gains.h"

namespace vinerow::controllers {

RateLaw::RateLaw(const RotorcraftModel& craft, const RateParams& params)
    : craft_(craft), params_(params) {}

void RateLaw::reset() {
  integral_.setZero();
  slope_.setZero();
  cut_Nm_.setZero();
  has_before_ = false;
}

Eigen::Vector3d RateLaw::step(const Eigen::Vector3d& wanted_radps, const Eigen::Vector3d& w_B,
                              const Eigen::Vector3d& lost_torque_Nm, bool integrate) {
  const Eigen::Vector3d error = wanted_radps - w_B;
  if (has_before_) {
    const double share = params_.period_s / (params_.period_s + params_.filter_s);
    slope_ += share * ((w_B - w_before_) / params_.period_s - slope_);
  }
  w_before_ = w_B;
  has_before_ = true;

  const Eigen::Vector3d lost = lost_torque_Nm + cut_Nm_;
  for (int axis = 0; integrate && axis < 3; ++axis) {
    const double growth = params_.period_s * spread(params_.i_per_s2)(axis) * error(axis);
    const double noise_Nm = 1e-6 * params_.torque_limits_Nm(axis);
    const bool is_lost = std::abs(lost(axis)) > noise_Nm && lost(axis) * growth > 0.0;
    if (!is_lost) integral_(axis) += growth;
  }

  const Eigen::Vector3d alpha = spread(params_.p_per_s).cwiseProduct(error) + integral_ -
                                spread(params_.d).cwiseProduct(slope_);
  const Eigen::Vector3d& J = craft_.inertia_kgm2;
  const Eigen::Vector3d torque = J.cwiseProduct(alpha) + w_B.cross(J.cwiseProduct(w_B));
  const Eigen::Vector3d limited =
      torque.cwiseMax(-params_.torque_limits_Nm).cwiseMin(params_.torque_limits_Nm);
  cut_Nm_ = torque - limited;
  return limited;
}

}  // namespace vinerow::controllers
