/// Parts that misbehave, for tests of what the kernel then does: a controller throws, one writes
/// NaN, a vehicle is wrecked. Each is well until t = 0.5 s.

#include <cmath>
#include <stdexcept>

#include "engine/api/messages/commands.h"
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

/// Stands where it was put.
class Wreck final : public Vehicle {
 public:
  Wreck() { description_.type = "wreck"; }
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld&, const Pose& X_WB) override { X_WB_ = X_WB; }
  void connect(Ports&) override {}
  void actuate(std::span<const double>) override {}
  void before_physics(Time, Duration) override {}
  void after_physics(Time now, Duration) override { crashed_ = crashed_ || now.s() >= 0.5; }
  void read_truth(Odometry& truth) const override { truth.X_WB = X_WB_; }
  Eigen::Vector3d specific_force_B() const override { return {0, 0, 9.8}; }
  std::string_view crash() const override {
    return crashed_ ? "fell off its trailer" : std::string_view();
  }
  void read_links(std::vector<Pose>&) const override {}
  void publish(Time) override {}

 private:
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  Pose X_WB_;
  bool crashed_ = false;
};

void register_parts(Registry& registry) {
  PartSpec wreck;
  wreck.name = "wreck";
  wreck.description = "is wrecked at t = 0.5 s";
  registry.add_vehicle(
      wreck, [](const ParameterSet&, const VehicleContext&) { return std::make_unique<Wreck>(); });
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
