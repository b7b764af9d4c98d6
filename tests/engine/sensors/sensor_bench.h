#pragma once
/// What a sensor needs in a test: a scene, level ground at first, and a vehicle whose readings the
/// test sets.

#include "engine/api/stepped_parts.h"
#include "engine/api/world_model.h"
#include "tests/support/plain_scene.h"

namespace vinerow::test {

/// Only has the specific force, the velocity through the air, and the states of one steered axle
/// and one wheel.
class FixedVehicle final : public Vehicle {
 public:
  Eigen::Vector3d specific_force = {0, 0, 9.80665};
  Eigen::Vector3d air_velocity = {12.0, -0.5, -1.5};
  std::vector<double> states = {0.1, -3.0};

  FixedVehicle() {
    description_.type = "fixed";
    description_.actuators = {{"axle_steer_rad", "rad", -0.4, 0.4},
                              {"wheel_speed_radps", "rad/s", -8.0, 8.0}};
  }

  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld&, const Pose&) override {}
  void connect(Ports&) override {}
  void actuate(std::span<const double>) override {}
  void before_physics(Time, Duration) override {}
  void after_physics(Time, Duration) override {}
  void read_truth(Odometry&) const override {}
  Eigen::Vector3d specific_force_B() const override { return specific_force; }
  Eigen::Vector3d air_velocity_B() const override { return air_velocity; }
  std::span<const double> actuator_states() const override { return states; }
  void read_links(std::vector<Pose>&) const override {}
  void publish(Time) override {}

  VehicleDescription description_;

 private:
  std::vector<VehicleLink> links_;
};

/// Everything a sensor needs, and its signals.
struct SensorBench {
  PlainScene scene{GroundPlane{}};
  FixedVehicle vehicle;
  WorldModel world;
  SignalBus bus;
  SignalWriter<Odometry> truth = bus.advertise<Odometry>("rover/truth", "rover");
  SignalWriter<PlannedPath> plan = bus.advertise<PlannedPath>("rover/plan", "rover");

  SensorContext context(double rate_Hz, std::uint64_t seed = 1) {
    SensorContext result;
    result.vehicle = "rover";
    result.part = "rover.sensors.s";
    result.name = "s";
    result.seed = seed;
    result.period = period_of_rate(rate_Hz);
    result.scene = &scene;
    result.light = [this]() -> const RayScene& { return scene; };
    result.world = &world;
    result.vehicle_truth = &vehicle;
    return result;
  }
  void connect(Sensor& sensor) {
    Ports ports(bus, "rover", "rover.sensors.s");
    sensor.connect(ports);
  }
};

}  // namespace vinerow::test
