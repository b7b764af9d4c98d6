#pragma once
/// Signals of a path follower that drives its vehicle by speed and yaw rate.

#include <memory>

#include "controllers/parts/ground_drive/stop_profile.h"
#include "controllers/parts/ground_drive/twist_drive.h"
#include "controllers/parts/paths/pose2.h"
#include "engine/api/messages/event.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// The followers' common ports. Reads "estimate", "plan" and, if it is written, "authority"; writes
/// "actuators", "command", "follower".
class DrivePorts {
 public:
  /// @throws ConfigError as make_twist_drive()
  DrivePorts(const ControllerContext& context, const std::string& type);

  void connect(Ports& ports);

  /// Reports an event. Allocates.
  void report_event(Time now, Event::Level level, const std::string& text) {
    event_.write(now, {level, part_, text});
  }

  /// True once per new plan.
  bool has_new_plan() { return plan_.is_newer_than(seen_plan_); }
  const PlannedPath& plan() const { return plan_.value(); }
  /// Why the vehicle cannot drive the plan: a corner that requires a turn on the spot. Empty if it
  /// can.
  std::string find_fault_in_plan() const;
  /// The speed straight ahead that the wheels reach, if it is less than the wanted one.
  double reachable_mps(double wanted_mps) const { return drive_->limit({wanted_mps, 0.0}).v_mps; }
  /// Warns if the wheels do not reach the follower's speed, or if the plan wants more than that.
  /// Allocates. @param wanted_mps  its parameter speed_mps
  void report_slower_speed(Time now, double wanted_mps);
  bool has_estimate() const { return estimate_.has_value(); }
  const Odometry& estimate() const { return estimate_.value(); }
  Pose2 pose() const;
  /// Distance along the plan at which to stop; +infinity: none.
  double stop_at_m() const { return read_stop_at_m(authority_); }

  /// Writes wheel speeds, command and follower state. No heap.
  void write(Time now, const VelocityCommand& command, const FollowerState& state) {
    write(now, command, command, state);
  }
  /// The same with wheel speeds that differ from the command's (compensated slip).
  void write(Time now, const VelocityCommand& command, const VelocityCommand& wheels,
             const FollowerState& state);

  const TwistDrive& drive() const { return *drive_; }

 private:
  std::unique_ptr<TwistDrive> drive_;
  std::string part_;
  NamedValues actuator_values_;
  std::uint64_t seen_plan_ = 0;
  SignalReader<Odometry> estimate_;
  SignalReader<PlannedPath> plan_;
  SignalReader<MovementAuthority> authority_;
  SignalWriter<NamedValues> actuators_;
  SignalWriter<VelocityCommand> command_;
  SignalWriter<FollowerState> follower_;
  SignalWriter<Event> event_;
};

}  // namespace vinerow::controllers
