/// Controllers that misbehave, for tests of what the kernel then does: one throws, one writes NaN,
/// one writes for an actuator that the vehicle does not have. Each is well until t = 0.5 s.

#include <cmath>
#include <stdexcept>

#include "engine/api/plugin.h"

namespace {

using namespace vinerow;

class Faulty final : public Controller {
 public:
  Faulty(std::string fault, const ControllerContext& context) : fault_(std::move(fault)) {
    for (const ActuatorSpec& actuator : context.vehicle_description->actuators)
      command_.names.push_back(actuator.name);
    command_.values.assign(command_.names.size(), 1.0);
  }
  void connect(Ports& ports) override { actuators_ = ports.write<NamedValues>("actuators"); }
  void step(Time now) override {
    if (now.s() >= 0.5) {
      if (fault_ == "throws") throw std::runtime_error("the gearbox is on fire");
      if (fault_ == "writes_nan") command_.values[0] = std::nan("");
    }
    actuators_.write(now, command_);
  }

 private:
  std::string fault_;
  NamedValues command_;
  SignalWriter<NamedValues> actuators_;
};

void register_parts(Registry& registry) {
  for (const char* fault : {"throws", "writes_nan"}) {
    PartSpec spec;
    spec.name = fault;
    spec.description = "misbehaves at t = 0.5 s";
    spec.default_rate_Hz = 20.0;
    registry.add_controller(spec, [fault](const ParameterSet&, const ControllerContext& context) {
      return std::make_unique<Faulty>(fault, context);
    });
  }
}

}  // namespace

VINEROW_PLUGIN(register_parts)
