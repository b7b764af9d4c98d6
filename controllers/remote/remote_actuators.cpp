#include "controllers/remote/remote_actuators.h"

#include <algorithm>

#include "controllers/remote/command_watch.h"
#include "engine/api/messages/commands.h"
#include "engine/api/parameter_table.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {
namespace {

struct RemoteActuatorParams {
  double timeout_s = kCommandTimeout_s;
};

const ParameterTable<RemoteActuatorParams>& remote_actuators_table() {
  using P = RemoteActuatorParams;
  static const ParameterTable<P> table = ParameterTable<P>().number(
      "timeout_s", "s", &P::timeout_s, between(0.0, 1e6), kCommandTimeoutWords);
  return table;
}

class RemoteActuators final : public Controller {
 public:
  RemoteActuators(const RemoteActuatorParams& params, const ControllerContext& context)
      : watch_(params.timeout_s, context.part, "actuator_command") {
    VINEROW_DEMAND(context.vehicle_description != nullptr);
    for (const ActuatorSpec& actuator : context.vehicle_description->actuators) {
      values_.names.push_back(actuator.name);
      values_.values.push_back(0.0);
    }
  }

  void connect(Ports& ports) override {
    wanted_ = ports.read_from_outside<NamedValues>("actuator_command");
    actuators_ = ports.write<NamedValues>("actuators");
    watch_.connect(ports);
  }

  void step(Time now) override {
    const bool is_fresh = watch_.is_fresh(now, wanted_);
    if (!is_fresh) {
      std::fill(values_.values.begin(), values_.values.end(), 0.0);
    } else if (wanted_.is_newer_than(seen_)) {
      take(wanted_.value());
    }
    actuators_.write(now, values_);
  }

 private:
  /// Sets the named actuators; the others keep their values. The run has checked the names.
  void take(const NamedValues& wanted) {
    for (std::size_t i = 0; i < wanted.names.size(); ++i) {
      const auto name = std::find(values_.names.begin(), values_.names.end(), wanted.names[i]);
      if (name == values_.names.end()) continue;
      values_.values[static_cast<std::size_t>(name - values_.names.begin())] = wanted.values[i];
    }
  }

  CommandWatch watch_;
  NamedValues values_;
  std::uint64_t seen_ = 0;
  SignalReader<NamedValues> wanted_;
  SignalWriter<NamedValues> actuators_;
};

}  // namespace

PartSpec remote_actuators_spec() {
  PartSpec spec;
  spec.name = "remote_actuators";
  spec.description =
      "Passes on actuator commands from outside the run (actuator_command), which name any of the "
      "vehicle's actuators; the others keep their values. All are zero if no command has come for "
      "timeout_s.";
  remote_actuators_table().add_to(spec);
  spec.default_rate_Hz = 100.0;
  spec.reads = {"actuator_command"};
  spec.writes = {"actuators", "controller_event"};
  return spec;
}

std::unique_ptr<Controller> make_remote_actuators(const ParameterSet& parameters,
                                                  const ControllerContext& context) {
  return std::make_unique<RemoteActuators>(
      remote_actuators_table().read(parameters, context.part + " (remote_actuators)"), context);
}

}  // namespace vinerow::controllers
