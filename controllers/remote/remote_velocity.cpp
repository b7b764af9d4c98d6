#include "controllers/remote/remote_velocity.h"

#include <fmt/format.h>

#include <algorithm>

#include "controllers/parts/ground_drive/twist_drive.h"
#include "controllers/remote/command_watch.h"
#include "engine/api/messages/commands.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

struct RemoteVelocityParams {
  double timeout_s = kCommandTimeout_s;
  double max_speed_mps = 0.0;
  double max_yaw_rate_radps = 0.0;
  double acceleration_mps2 = 0.0;
  double yaw_acceleration_radps2 = 0.0;
};

const ParameterTable<RemoteVelocityParams>& remote_velocity_table() {
  using P = RemoteVelocityParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("timeout_s", "s", &P::timeout_s, between(0.0, 1e6), kCommandTimeoutWords)
          .number("max_speed_mps", "m/s", &P::max_speed_mps, between(0.0, 100.0),
                  "limit of the speed in both directions; 0 = only the vehicle's own")
          .number("max_yaw_rate_radps", "rad/s", &P::max_yaw_rate_radps, between(0.0, 100.0),
                  "limit of the yaw rate; 0 = only the vehicle's own")
          .number("acceleration_mps2", "m/s2", &P::acceleration_mps2, between(0.0, 1e3),
                  "limit of the change of speed; 0 = none")
          .number("yaw_acceleration_radps2", "rad/s2", &P::yaw_acceleration_radps2,
                  between(0.0, 1e3), "limit of the change of yaw rate; 0 = none");
  return table;
}

/// `wanted` within +-limit; a limit of 0 means none.
double within(double wanted, double limit) {
  return limit > 0.0 ? std::clamp(wanted, -limit, limit) : wanted;
}

/// The value nearest to `wanted` that a limited rate reaches from `from`; a rate of 0 means no
/// limit.
double approach(double from, double wanted, double rate, double period_s) {
  return rate > 0.0 ? std::clamp(wanted, from - rate * period_s, from + rate * period_s) : wanted;
}

class RemoteVelocity final : public Controller {
 public:
  RemoteVelocity(const RemoteVelocityParams& params, const ControllerContext& context)
      : params_(params),
        watch_(params.timeout_s, context.part, "cmd_vel"),
        period_s_(context.period.s()) {
    VINEROW_DEMAND(context.vehicle_description != nullptr);
    drive_ = make_twist_drive(*context.vehicle_description,
                              fmt::format("{} (remote_velocity)", context.part));
    actuator_values_ = drive_->make_actuators();
  }

  void connect(Ports& ports) override {
    wanted_ = ports.read_from_outside<VelocityCommand>("cmd_vel");
    actuators_ = ports.write<NamedValues>("actuators");
    command_ = ports.write<VelocityCommand>("command");
    watch_.connect(ports);
  }

  void step(Time now) override {
    const bool is_fresh = watch_.is_fresh(now, wanted_);
    const VelocityCommand wanted = is_fresh ? wanted_.value() : VelocityCommand{};
    last_.v_mps = approach(last_.v_mps, within(wanted.v_mps, params_.max_speed_mps),
                           params_.acceleration_mps2, period_s_);
    last_.yaw_rate_radps =
        approach(last_.yaw_rate_radps, within(wanted.yaw_rate_radps, params_.max_yaw_rate_radps),
                 params_.yaw_acceleration_radps2, period_s_);
    last_ = drive_->limit(last_);
    drive_->mix(last_, actuator_values_);
    actuators_.write(now, actuator_values_);
    command_.write(now, last_);
  }

 private:
  RemoteVelocityParams params_;
  CommandWatch watch_;
  double period_s_;
  std::unique_ptr<TwistDrive> drive_;
  NamedValues actuator_values_;
  VelocityCommand last_;
  SignalReader<VelocityCommand> wanted_;
  SignalWriter<NamedValues> actuators_;
  SignalWriter<VelocityCommand> command_;
};

}  // namespace

PartSpec remote_velocity_spec() {
  PartSpec spec;
  spec.name = "remote_velocity";
  spec.description =
      "Drives by speed and yaw rate from outside the run (cmd_vel): a ROS 2 node, a viewer, a "
      "program with a session. Stops if no command has come for timeout_s.";
  remote_velocity_table().add_to(spec);
  spec.default_rate_Hz = 50.0;
  spec.reads = {"cmd_vel"};
  spec.writes = {"actuators", "command", "controller_event"};
  return spec;
}

std::unique_ptr<Controller> make_remote_velocity(const ParameterSet& parameters,
                                                 const ControllerContext& context) {
  return std::make_unique<RemoteVelocity>(
      remote_velocity_table().read(parameters, context.part + " (remote_velocity)"), context);
}

}  // namespace vinerow::controllers
