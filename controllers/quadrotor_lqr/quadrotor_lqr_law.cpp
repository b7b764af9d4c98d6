#include "controllers/quadrotor_lqr/quadrotor_lqr_law.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "controllers/parts/solvers/discretise.h"
#include "controllers/parts/solvers/riccati.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

/// Weights of the wrench states, per acceleration: small, but no state is without weight.
constexpr double kWrenchWeight = 1e-6;

Eigen::MatrixXd make_gain(const RotorcraftModel& craft, const LqrParams& params,
                          const std::string& who) {
  const HoverModel model = make_hover_model(craft, craft.rotor_lag_s > 0.0);
  const SampledModel sampled = discretise(model.A, model.B, params.period_s);
  const Eigen::Vector4d inertia(craft.mass_kg, craft.inertia_kgm2.x(), craft.inertia_kgm2.y(),
                                craft.inertia_kgm2.z());
  const Eigen::Vector4d per_acceleration = inertia.cwiseAbs2().cwiseInverse();
  const auto spread = [](const Eigen::Vector2d& pair) {
    return Eigen::Vector3d(pair.x(), pair.x(), pair.y());
  };
  Eigen::VectorXd q(model.A.rows());
  q.segment<3>(kHoverPosition) = spread(params.position_per_m2);
  q.segment<3>(kHoverVelocity) = spread(params.velocity_per_mps2);
  q.segment<3>(kHoverAngle) = spread(params.angle_per_rad2);
  q.segment<3>(kHoverRate) = spread(params.rate_per_radps2);
  if (q.size() > kHoverWrench) q.tail<4>() = kWrenchWeight * per_acceleration;
  Eigen::Vector4d r;
  r << params.thrust_weight, spread(params.torque_weight);
  const Eigen::MatrixXd Q = q.asDiagonal();
  const Eigen::MatrixXd R = r.cwiseProduct(per_acceleration).asDiagonal();
  const Result<Eigen::MatrixXd> P = solve_dare(sampled.A, sampled.B, Q, R);
  if (!P) throw ConfigError(fmt::format("{}: no LQR gain: {}", who, P.reason()));
  return lqr_gain(sampled.A, sampled.B, R, *P);
}

}  // namespace

QuadrotorLqrLaw::QuadrotorLqrLaw(const RotorcraftModel& craft, const RotorMixer& mixer,
                                 const FlightLimits& limits, const LqrParams& params,
                                 const std::string& who)
    : craft_(craft),
      limits_(limits),
      period_s_(params.period_s),
      rotors_(craft, mixer),
      hover_radps_(craft.rotors.size(), 0.0),
      disturbance_(craft, params.disturbance_s, true, params.period_s),
      gain_(make_gain(craft, params, who)),
      error_(Eigen::VectorXd::Zero(gain_.cols())) {
  set_up_limits(limits);
  RotorMixer(mixer).mix({craft.mass_kg * craft.gravity_mps2, Eigen::Vector3d::Zero()},
                        hover_radps_);
}

void QuadrotorLqrLaw::set_up_limits(const FlightLimits& limits) {
  const Eigen::Matrix2d tilt = gain_.block<2, 2>(1, kHoverAngle);
  Eigen::Matrix<double, 2, 4> errors;
  errors << gain_.block<2, 2>(1, kHoverPosition), gain_.block<2, 2>(1, kHoverVelocity);
  tilt_of_errors_ = tilt.inverse() * errors;
  // The speed of a correction is where the shares of position and speed cancel.
  const double per_m = tilt_of_errors_(1, 0), per_mps = tilt_of_errors_(1, 2);
  max_error_m_.x() = limits.correction_mps * per_mps / per_m;
  max_error_m_.y() = max_error_m_.x();
  max_error_m_.z() =
      limits.climb_correction_mps * gain_(0, kHoverVelocity + 2) / gain_(0, kHoverPosition + 2);
  max_yaw_error_rad_ = limits.yaw_rate_radps * gain_(3, kHoverRate + 2) / gain_(3, kHoverAngle + 2);
}

void QuadrotorLqrLaw::reset(bool hovering) {
  disturbance_.reset();
  rotors_.reset();
  if (hovering) rotors_.set_speeds(hover_radps_);
}

void QuadrotorLqrLaw::command(const std::vector<double>& speeds_radps) {
  rotors_.command(speeds_radps, period_s_);
}

Eigen::Vector2d QuadrotorLqrLaw::limit_tilt(const Eigen::Vector2d& tilt_rad) const {
  const double tilt = tilt_rad.norm();
  return tilt > limits_.tilt_rad ? Eigen::Vector2d(tilt_rad * (limits_.tilt_rad / tilt)) : tilt_rad;
}

Wrench QuadrotorLqrLaw::step(const TrajectoryPoint& at, const Odometry& odometry, bool learn) {
  disturbance_.update(odometry, rotors_.mean(), learn);
  const HoverFrame frame(at);
  const HoverState state = calc_hover_state(odometry, frame);
  const double weight_N = craft_.mass_kg * craft_.gravity_mps2;
  const double yaw = state.x(kHoverAngle + 2);

  // Feed-forward: acceleration of the rotors without weight, torques.
  const Eigen::Vector3d v_ref = frame.from_W(at.v_W);
  const Eigen::Vector3d a_ref = frame.from_W(at.a_W - disturbance_.acceleration_W()) +
                                craft_.rotor_drag_Ns_per_m / craft_.mass_kg * v_ref;
  Wrench counter;  // of unknown torques, in B
  counter.torque_B = -craft_.inertia_kgm2.cwiseProduct(disturbance_.angular_B());
  Eigen::Vector4d u_ref = calc_hover_wrench(counter, state, weight_N);
  u_ref(0) = craft_.mass_kg * a_ref.z();
  const double lift = std::max(craft_.gravity_mps2 + a_ref.z(), 0.1 * craft_.gravity_mps2);
  const Eigen::Vector2d tilt_ref(-std::atan2(a_ref.y(), lift), std::atan2(a_ref.x(), lift));

  // Bounded errors. Those of horizontal position and velocity act through the wanted tilt.
  Eigen::Vector3d p_error = state.x.segment<3>(kHoverPosition);
  const double away_m = p_error.head<2>().norm();
  if (away_m > max_error_m_.x()) p_error.head<2>() *= max_error_m_.x() / away_m;
  p_error.z() = std::clamp(p_error.z(), -max_error_m_.z(), max_error_m_.z());
  const Eigen::Vector3d v_error = state.x.segment<3>(kHoverVelocity) - v_ref;
  Eigen::Vector4d horizontal;
  horizontal << p_error.head<2>(), v_error.head<2>();
  const Eigen::Vector2d tilt_wanted = limit_tilt(tilt_ref - tilt_of_errors_ * horizontal);
  error_.setZero();
  error_(kHoverPosition + 2) = p_error.z();
  error_(kHoverVelocity + 2) = v_error.z();
  error_.segment<2>(kHoverAngle) = state.x.segment<2>(kHoverAngle) - tilt_wanted;
  error_(kHoverAngle + 2) = std::clamp(yaw, -max_yaw_error_rad_, max_yaw_error_rad_);
  error_.segment<3>(kHoverRate) = state.x.segment<3>(kHoverRate);
  error_(kHoverRate + 2) -= at.yaw_rate_radps;
  if (error_.size() > kHoverWrench) {
    error_.tail<4>() = calc_hover_wrench(rotors_.now(), state, weight_N) - u_ref;
  }

  Eigen::Vector4d u = u_ref;
  u.noalias() -= gain_ * error_;
  Wrench wanted = calc_body_wrench(u, state, weight_N);
  wanted.thrust_N = std::clamp(wanted.thrust_N, limits_.min_thrust_N, limits_.max_thrust_N);
  wanted.torque_B = wanted.torque_B.cwiseMax(-limits_.torque_Nm).cwiseMin(limits_.torque_Nm);
  return wanted;
}

}  // namespace vinerow::controllers
