#include "vehicles/fixed_wing/launcher.h"

#include <algorithm>
#include <cmath>

namespace vinerow::vehicles {

void Launcher::hold(const LaunchParams& params, const Eigen::Vector3d& ground_W, double yaw_rad) {
  phase_ = Phase::kWait;
  speed_mps_ = params.speed_mps;
  length_m_ = params.length_m;
  const double climb_rad = params.elevation_rad;
  along_W_ = {std::cos(climb_rad) * std::cos(yaw_rad), std::cos(climb_rad) * std::sin(yaw_rad),
              std::sin(climb_rad)};
  start_W_ = ground_W + Eigen::Vector3d(0.0, 0.0, params.height_m);
  acceleration_W_.setZero();
  state_.X_WB.p = start_W_;
  // Pitch of W's axes is positive with the nose down.
  state_.X_WB.q = quaternion_from_rpy({0.0, -(climb_rad + params.incidence_rad), yaw_rad});
  state_.v_WB_W.setZero();
  state_.w_WB_W.setZero();
}

void Launcher::push(double dt_s) {
  phase_ = Phase::kPush;
  step_s_ = dt_s;
  step_ = 0;
  steps_ = std::max(1L, std::lround(2.0 * length_m_ / (speed_mps_ * dt_s)));
  acceleration_W_ = speed_mps_ / (static_cast<double>(steps_) * dt_s) * along_W_;
}

const physics::BodyState& Launcher::advance() {
  if (phase_ != Phase::kPush) return state_;
  ++step_;
  const double time_s = static_cast<double>(step_) * step_s_;
  state_.v_WB_W = time_s * acceleration_W_;
  state_.X_WB.p = start_W_ + 0.5 * time_s * time_s * acceleration_W_;
  if (step_ == steps_) phase_ = Phase::kFree;
  return state_;
}

}  // namespace vinerow::vehicles
