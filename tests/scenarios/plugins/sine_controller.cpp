/// A controller whose commands are sines: for the test that a plug-in calls the simulator's
/// elementary functions in every process (tests/python/session_test.py).

#include <cmath>

#include "engine/api/messages/commands.h"
#include "engine/api/plugin.h"

namespace {

using namespace vinerow;

class SineController final : public Controller {
 public:
  explicit SineController(const ControllerContext& context) {
    for (const ActuatorSpec& actuator : context.vehicle_description->actuators) {
      command_.names.push_back(actuator.name);
    }
    command_.values.assign(command_.names.size(), 0.0);
  }
  void connect(Ports& ports) override { actuators_ = ports.write<NamedValues>("actuators"); }
  void step(Time now) override {
    for (std::size_t i = 0; i < command_.values.size(); ++i) {
      command_.values[i] = 2.0 + std::sin(7.0 * now.s() + static_cast<double>(i));
    }
    actuators_.write(now, command_);
  }

 private:
  NamedValues command_;
  SignalWriter<NamedValues> actuators_;
};

void register_parts(Registry& registry) {
  PartSpec spec;
  spec.name = "sine";
  spec.description = "commands sines of the time";
  spec.default_rate_Hz = 100.0;
  registry.add_controller(spec, [](const ParameterSet&, const ControllerContext& context) {
    return std::make_unique<SineController>(context);
  });
}

}  // namespace

VINEROW_PLUGIN(register_parts)
