#include "controllers/parts/ground_drive/drive_ports.h"

#include <fmt/format.h>

#include "controllers/parts/ground_drive/plan_speed.h"
#include "controllers/parts/paths/path_corners.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

DrivePorts::DrivePorts(const ControllerContext& context, const std::string& type) {
  const std::string who = fmt::format("{} ({})", context.part, type);
  VINEROW_DEMAND(context.vehicle_description != nullptr);
  if (context.period.ns <= 0) {
    throw ConfigError(fmt::format("{}: rate_Hz must be > 0", who));
  }
  part_ = context.part;
  drive_ = make_twist_drive(*context.vehicle_description, who);
  actuator_values_ = drive_->make_actuators();
}

void DrivePorts::connect(Ports& ports) {
  estimate_ = ports.read<Odometry>("estimate");
  plan_ = ports.read<PlannedPath>("plan");
  authority_ = ports.read_optional<MovementAuthority>("authority");
  actuators_ = ports.write<NamedValues>("actuators");
  command_ = ports.write<VelocityCommand>("command");
  follower_ = ports.write<FollowerState>("follower");
  event_ = ports.write<Event>("controller_event");
}

std::string DrivePorts::find_fault_in_plan() const {
  if (drive_->turns_on_the_spot()) return {};
  const std::vector<PathCorner> corners = find_corners(plan(), kSharpCorner_rad);
  if (corners.empty()) return {};
  const auto& corner = plan().points[static_cast<std::size_t>(corners.front().point)];
  return fmt::format(
      "the plan turns by {:.0f} deg at ({:.2f}, {:.2f}), and a vehicle that steers by its front "
      "axle cannot turn on the spot",
      std::abs(deg_from_rad(corners.front().turn_rad)), corner.p_W.x(), corner.p_W.y());
}

void DrivePorts::report_slower_speed(Time now, double wanted_mps) {
  for (const std::string& text :
       describe_slower_speeds(plan(), wanted_mps, reachable_mps(wanted_mps))) {
    report_event(now, Event::Level::kWarning, text);
  }
}

Pose2 DrivePorts::pose() const {
  const Pose& X_WB = estimate_.value().X_WB;
  return {X_WB.p.head<2>(), yaw_from_quaternion(X_WB.q)};
}

void DrivePorts::write(Time now, const VelocityCommand& command, const VelocityCommand& wheels,
                       const FollowerState& state) {
  drive_->mix(wheels, actuator_values_);
  actuators_.write(now, actuator_values_);
  command_.write(now, command);
  follower_.write(now, state);
}

}  // namespace vinerow::controllers
