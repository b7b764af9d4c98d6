#include "controllers/four_wheel_steering/wheel_speed_qp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::controllers {
namespace {

// The cost in the form of QpSolver, up to a constant:
//   (alpha v - beta)^2 + rho |v - v_rb|^2 = 1/2 v'H v + f'v,
//   H = 2 (alpha alpha' + rho I),  f = -2 (beta alpha + rho v_rb).
// Two-sided form: alpha_i = 1 / reach_i, beta = 4 v_x, so alpha v = beta demands that the mean of
// v_i / reach_i is the forward speed v_x. Printed form: alpha_i = |k / reach_i|, beta = 4 |k| v_x,
// or 1 and 4 v if the axles are parallel, and v_rb = 0 with a negligible weight.
// Rows of A (eq. 33), with d_i the wheel angles in the order fl, fr, rl, rr:
//   cos(d_fl) v_fl - cos(d_rl) v_rl,  cos(d_fr) v_fr - cos(d_rr) v_rr   along the body,
//   sin(d_fl) v_fl - sin(d_fr) v_fr,  sin(d_rl) v_rl - sin(d_rr) v_rr   across the body.

// Weight of |v|^2 that makes the minimiser of the printed cost unique. Chosen: too small to change
// the value of the cost noticeably.
constexpr double kPrintedWeight = 1e-9;
// Curvature below which the printed rule takes the axles as parallel (ICR farther than 10^6 m).
// Chosen.
constexpr double kParallel_per_m = 1e-6;
// Smallest reach of a wheel. Chosen: a wheel near the ICR hardly moves, and 1 / reach must stay
// finite.
constexpr double kMinReach = 1e-3;

}  // namespace

WheelSpeedQp::WheelSpeedQp(const WheelSpeedParams& params)
    : params_(params),
      solver_(kWheels, kWheels),
      H_(Eigen::MatrixXd::Identity(kWheels, kWheels)),
      A_(Eigen::MatrixXd::Zero(kWheels, kWheels)),
      f_(Eigen::VectorXd::Zero(kWheels)),
      lower_(Eigen::VectorXd::Constant(kWheels, -params.rim_max_mps)),
      upper_(Eigen::VectorXd::Constant(kWheels, params.rim_max_mps)),
      row_lower_(Eigen::VectorXd::Constant(kWheels, params.form == WheelSpeedForm::kPrinted
                                                        ? -std::numeric_limits<double>::infinity()
                                                        : -params.slip_mps)),
      row_upper_(Eigen::VectorXd::Constant(kWheels, params.slip_mps)) {}

void WheelSpeedQp::set_problem(const Rolling& rolling, double speed_mps) {
  rolling_mps_ = rolling.rim_mps(speed_mps);
  const Eigen::Array4d cosine = rolling.wheel_rad.array().cos(),
                       sine = rolling.wheel_rad.array().sin();
  A_(0, 0) = cosine[0], A_(0, 2) = -cosine[2];
  A_(1, 1) = cosine[1], A_(1, 3) = -cosine[3];
  A_(2, 0) = sine[0], A_(2, 1) = -sine[1];
  A_(3, 2) = sine[2], A_(3, 3) = -sine[3];

  if (params_.form == WheelSpeedForm::kPrinted) {
    const double k = rolling.curvature_per_m;
    if (std::abs(k) < kParallel_per_m) {
      alpha_.setOnes();
      beta_ = 4.0 * speed_mps;
    } else {
      // Eq. 28 has the distance without sign.
      alpha_ = (rolling.reach / k).cwiseAbs().cwiseMax(kMinReach).cwiseInverse();
      beta_ = 4.0 * std::abs(k) * rolling.forward_mps(speed_mps);
    }
    H_ = 2.0 * (alpha_ * alpha_.transpose());
    H_.diagonal().array() += 2.0 * kPrintedWeight;
    f_ = -2.0 * beta_ * alpha_;
  } else {
    for (int i = 0; i < kWheels; ++i) {
      const double reach = rolling.reach[i];
      alpha_[i] = 1.0 / std::copysign(std::max(std::abs(reach), kMinReach), reach);
    }
    beta_ = 4.0 * rolling.forward_mps(speed_mps);
    H_ = 2.0 * (alpha_ * alpha_.transpose());
    H_.diagonal().array() += 2.0 * params_.rolling_weight;
    f_ = -2.0 * (beta_ * alpha_ + params_.rolling_weight * rolling_mps_);
  }
  // Limit of wheel acceleration: a box about the last speeds.
  if (params_.rim_change_max_mps > 0.0) {
    lower_ = (last_mps_.array() - params_.rim_change_max_mps).max(-params_.rim_max_mps);
    upper_ = (last_mps_.array() + params_.rim_change_max_mps).min(params_.rim_max_mps);
  }
}

QpStatus WheelSpeedQp::solve(const Rolling& rolling, double speed_mps) {
  set_problem(rolling, speed_mps);
  if (!solver_.set_hessian(H_)) return QpStatus::kNotConvex;
  solver_.set_rows(A_);
  return solver_.solve(f_, lower_, upper_, row_lower_, row_upper_);
}

double WheelSpeedQp::cost(const Eigen::Vector4d& rim_mps) const {
  const double miss = alpha_.dot(rim_mps) - beta_;
  return miss * miss;
}

}  // namespace vinerow::controllers
