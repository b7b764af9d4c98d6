#include "controllers/quadrotor_pid/position_law.h"

#include <algorithm>
#include <cmath>

#include "controllers/quadrotor_pid/axis_gains.h"

namespace vinerow::controllers {

PositionLaw::PositionLaw(const RotorcraftModel& craft, const PositionParams& params)
    : craft_(craft), params_(params) {}

void PositionLaw::reset() {
  integral_.setZero();
  slope_.setZero();
  has_before_ = false;
}

Eigen::Vector3d PositionLaw::step(const TrajectoryPoint& at, const Eigen::Vector3d& p_W,
                                  const Eigen::Vector3d& v_W, double lost_thrust_N,
                                  bool integrate_now) {
  Eigen::Vector3d correction = spread(params_.position_p_per_s).cwiseProduct(at.p_W - p_W);
  const double horizontal = correction.head<2>().norm();
  if (horizontal > params_.correction_speed_mps.x()) {
    correction.head<2>() *= params_.correction_speed_mps.x() / horizontal;
  }
  correction.z() = std::clamp(correction.z(), -params_.correction_speed_mps.y(),
                              params_.correction_speed_mps.y());
  const Eigen::Vector3d v_error = at.v_W + correction - v_W;

  if (has_before_) {
    const double share = params_.period_s / (params_.period_s + params_.velocity_filter_s);
    slope_ += share * ((v_W - v_before_) / params_.period_s - slope_);
  }
  v_before_ = v_W;
  has_before_ = true;

  const Eigen::Vector3d a_wanted = at.a_W + spread(params_.velocity_p_per_s).cwiseProduct(v_error) +
                                   integral_ - spread(params_.velocity_d).cwiseProduct(slope_);
  Eigen::Vector3d F_W = craft_.mass_kg * a_wanted + craft_.rotor_drag_Ns_per_m * at.v_W;
  F_W.z() += craft_.mass_kg * craft_.gravity_mps2;
  const Eigen::Vector3d limited = limit(F_W);
  if (integrate_now) integrate(v_error, F_W, limited, lost_thrust_N);
  return limited;
}

Eigen::Vector3d PositionLaw::limit(const Eigen::Vector3d& F_W) const {
  Eigen::Vector3d F = F_W;
  F.z() = std::clamp(F.z(), params_.min_thrust_N, params_.max_thrust_N);
  const double by_tilt = F.z() * std::tan(params_.tilt_limit_rad);
  const double by_thrust =
      std::sqrt(std::max(params_.max_thrust_N * params_.max_thrust_N - F.z() * F.z(), 0.0));
  const double max_lateral_N = std::min(by_tilt, by_thrust), wanted = F.head<2>().norm();
  if (wanted > max_lateral_N) F.head<2>() *= max_lateral_N / wanted;
  return F;
}

void PositionLaw::integrate(const Eigen::Vector3d& v_error, const Eigen::Vector3d& wanted_N,
                            const Eigen::Vector3d& limited_N, double lost_thrust_N) {
  Eigen::Vector3d growth =
      params_.period_s * spread(params_.velocity_i_per_s2).cwiseProduct(v_error);
  // Along a horizontal force that is already limited only a reduction is integrated.
  const Eigen::Vector2d along = wanted_N.head<2>();
  if (along.norm() > limited_N.head<2>().norm() * (1.0 + 1e-9)) {
    const Eigen::Vector2d direction = along.normalized();
    const double outwards = growth.head<2>().dot(direction);
    if (outwards > 0.0) growth.head<2>() -= outwards * direction;
  }
  // The part of the thrust that the rotors do not reach, and the part beyond the limit.
  const double lost_N = wanted_N.z() - limited_N.z() + lost_thrust_N;
  const double noise_N = 1e-6 * craft_.mass_kg * craft_.gravity_mps2;
  if (std::abs(lost_N) > noise_N && lost_N * growth.z() > 0.0) growth.z() = 0.0;
  integral_ += growth;
}

}  // namespace vinerow::controllers
