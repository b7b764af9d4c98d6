#include "vehicles/payloads/section_switch.h"

#include "engine/api/map.h"

namespace vinerow::vehicles {

bool LaggingValve::follow(bool command, Time now, Duration lag) {
  if (command != command_) {
    command_ = command;
    due_ = now + lag;
  }
  if (now >= due_) open_ = command_;
  return open_;
}

SectionSwitch::SectionSwitch(const SprayerParams& params, const RowMap& map)
    : params_(params), lag_(duration_from_s(params.valve_lag_s)), rows_(map.rows) {}

void SectionSwitch::connect(Ports& ports) {
  estimate_ = ports.read<Odometry>("estimate");
  if (params_.on_legs_only) {
    // Checks that there is a planner: without legs nothing would ever be sprayed.
    static_cast<void>(ports.read<PlannedPath>("plan"));
    plan_.connect(ports);
  }
}

Sections SectionSwitch::step(Time now) {
  const Sections wants = wanted();
  return {left_.follow(wants.left, now, lag_), right_.follow(wants.right, now, lag_)};
}

Sections SectionSwitch::wanted() {
  if (!estimate_.has_value()) return {};
  const Odometry& estimate = estimate_.value();
  const Eigen::Vector3d v_W = estimate.X_WB.q * estimate.v_WB_B;
  if (v_W.head<2>().norm() < params_.min_speed_mps) return {};
  if (params_.on_legs_only) {
    plan_.take_over();
    if (!plan_.has_plan() || !plan_.is_leg(plan_.find(estimate.X_WB.p).segment)) return {};
  }
  const Eigen::Vector3d boom_W =
      estimate.X_WB * Eigen::Vector3d(params_.boom_x_m, 0.0, 0.0) + params_.lead_s * v_W;
  const AdjacentRows adjacent =
      rows_.adjacent(boom_W.head<2>(), yaw_from_quaternion(estimate.X_WB.q), params_.row_reach_m,
                     params_.max_angle_rad, params_.beyond_end_m);
  return {adjacent.left.has_value(), adjacent.right.has_value()};
}

}  // namespace vinerow::vehicles
