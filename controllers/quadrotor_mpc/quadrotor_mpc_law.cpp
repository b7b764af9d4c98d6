#include "controllers/quadrotor_mpc/quadrotor_mpc_law.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "controllers/parts/solvers/discretise.h"

namespace vinerow::controllers {
namespace {

constexpr double kPull_m = 2.0;
constexpr double kAlong_m = 0.25;

Eigen::MatrixXd make_disturbance_input(const RotorcraftModel& craft, double period_s) {
  const HoverModel model = make_hover_model(craft, true);
  Eigen::MatrixXd accelerations = Eigen::MatrixXd::Zero(model.A.rows(), 6);
  accelerations.block<3, 3>(kHoverVelocity, 0).setIdentity();
  accelerations.block<3, 3>(kHoverRate, 3).setIdentity();
  return discretise(model.A, accelerations, period_s).B;
}

bool is_finite(const Odometry& odometry) {
  return odometry.X_WB.p.allFinite() && odometry.X_WB.q.coeffs().allFinite() &&
         odometry.v_WB_B.allFinite() && odometry.w_WB_B.allFinite();
}

}  // namespace

QuadrotorMpcLaw::QuadrotorMpcLaw(const RotorcraftModel& craft, const QuadrotorMpcParams& params,
                                 const std::string& who)
    : craft_(craft),
      params_(params),
      weight_N_(craft.mass_kg * craft.gravity_mps2),
      max_thrust_N_(std::min(params.max_thrust * weight_N_, craft.max_thrust_N())),
      mixer_(craft, who),
      max_torque_Nm_(params.torque_share * mixer_.torque_limits_at_hover()),
      rotors_(craft, mixer_),
      disturbance_(craft, params.disturbance_s, params.learns_torque, params.period_s),
      targets_(craft, params.horizon, params.period_s),
      mpc_(make_quadrotor_problem(craft, mixer_, params, who), who),
      disturbance_input_(make_disturbance_input(craft, params.period_s)),
      x_(Eigen::VectorXd::Zero(HoverModel::kStatesWithLag)),
      d_(x_),
      no_input_(Eigen::VectorXd::Zero(HoverModel::kInputs)),
      speeds_radps_(craft.rotors.size(), 0.0) {
  reset();
}

void QuadrotorMpcLaw::reset() {
  rotors_.reset();
  disturbance_.reset();
  mpc_.cold_start();
  status_ = QpStatus::kSolved;
  wanted_ = {};
}

void QuadrotorMpcLaw::reset_hovering() {
  reset();
  wanted_.thrust_N = weight_N_;
  mixer_.mix(wanted_, speeds_radps_);
  rotors_.set_speeds(speeds_radps_);
}

// Far from the reference, the problem gets a reference moved towards the vehicle, so that its
// errors stay of the size for which the weights were chosen. The limit of speed is for keeping the
// speed near the reference; a vehicle ahead or behind returns at a speed of its own.
void QuadrotorMpcLaw::pull_reference() {
  const double distance_m = x_.segment<3>(kHoverPosition).norm();
  if (distance_m > kPull_m) x_.segment<3>(kHoverPosition) *= kPull_m / distance_m;
  const double along_m = x_[kHoverPosition];
  const double excess_m = along_m - std::clamp(along_m, -kAlong_m, kAlong_m);
  if (excess_m != 0.0) targets_.lead_back(excess_m);
}

const Wrench& QuadrotorMpcLaw::step(const Odometry& odometry,
                                    const std::vector<TrajectoryPoint>& preview, bool learn) {
  if (!is_finite(odometry)) {
    status_ = QpStatus::kInvalidInput;
    return wanted_;
  }
  disturbance_.update(odometry, rotors_.mean(), learn);
  const HoverFrame frame(preview.front());
  state_ = calc_hover_state(odometry, frame);
  x_ << state_.x, calc_hover_wrench(rotors_.now(), state_, weight_N_);

  const Eigen::Vector3d push_H = frame.from_W(disturbance_.acceleration_W());
  const Eigen::Vector3d turn_H = frame.from_W(odometry.X_WB.q * disturbance_.angular_B());
  targets_.update(frame, preview, push_H, craft_.inertia_kgm2.cwiseProduct(turn_H));
  speed_error_mps_ = x_[kHoverVelocity] - targets_.states()(kHoverVelocity, 0);
  pull_reference();
  Eigen::Vector3d missing_H = push_H;
  missing_H.head<2>() += targets_.missed_mps2();
  d_.noalias() = disturbance_input_.leftCols<3>() * missing_H;
  d_.noalias() += disturbance_input_.rightCols<3>() * turn_H;
  status_ = mpc_.solve(x_, targets_.states(), targets_.inputs(), d_, no_input_);

  wanted_ = calc_body_wrench(mpc_.u(), state_, weight_N_);
  // The box of limits is in H; in B its corners may be outside.
  wanted_.thrust_N = std::min(wanted_.thrust_N, max_thrust_N_);
  wanted_.torque_B = wanted_.torque_B.cwiseMax(-max_torque_Nm_).cwiseMin(max_torque_Nm_);
  mixer_.mix(wanted_, speeds_radps_);
  rotors_.command(speeds_radps_, params_.period_s);
  return wanted_;
}

}  // namespace vinerow::controllers
