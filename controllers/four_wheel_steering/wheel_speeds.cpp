#include "controllers/four_wheel_steering/wheel_speeds.h"

#include <algorithm>

namespace vinerow::controllers {
namespace {

WheelSpeedParams with_form(WheelSpeedParams params, SpeedRule rule) {
  if (rule == SpeedRule::kQpPrinted) params.form = WheelSpeedForm::kPrinted;
  return params;
}

}  // namespace

WheelSpeeds::WheelSpeeds(const WheelSpeedsParams& params)
    : params_(params), qp_(with_form(params.qp, params.rule)) {}

void WheelSpeeds::slow_down() {
  const double fastest_mps = rim_mps_.cwiseAbs().maxCoeff();
  const double slower_mps = fastest_mps - params_.stop_mps2 * params_.cycle_s;
  rim_mps_ *= slower_mps > 0.0 ? slower_mps / fastest_mps : 0.0;
}

const Eigen::Vector4d& WheelSpeeds::update(const Rolling& rolling, double speed_mps) {
  if (has_failed()) {
    slow_down();
    return rim_mps_;
  }
  cost_ = slip_mps_ = 0.0;
  iterations_ = 0;
  if (params_.rule == SpeedRule::kEqual) {
    rim_mps_.setConstant(speed_mps);
    return rim_mps_;
  }
  const bool stands = speed_mps == 0.0 && rim_mps_.isZero(0.0);
  // Without a limit of change, zero speed is at rest; with one, the wheels may still be turning.
  if (stands || (speed_mps == 0.0 && params_.qp.rim_change_max_mps <= 0.0)) {
    rim_mps_.setZero();
    return rim_mps_;
  }
  qp_.set_last(rim_mps_);
  status_ = qp_.solve(rolling, speed_mps);
  iterations_ = qp_.iterations();
  if (has_failed()) {
    slow_down();
    return rim_mps_;
  }
  rim_mps_ = qp_.rim_mps();
  // Residues of the solver at rest count as zero.
  constexpr double kNothing_mps = 1e-9;
  if (speed_mps == 0.0 && rim_mps_.cwiseAbs().maxCoeff() < kNothing_mps) rim_mps_.setZero();
  cost_ = qp_.cost(rim_mps_);
  slip_mps_ = qp_.slip_mps(rim_mps_).cwiseAbs().maxCoeff();
  return rim_mps_;
}

}  // namespace vinerow::controllers
