#pragma once
/// A scene and a vehicle for sensor tests: ground z = 0 and one wall, and a body that moves as the
/// test says.

#include "engine/api/stepped_parts.h"
#include "engine/api/world_model.h"

namespace vinerow::test {

/// Rays see the ground z = ground_slope x and the wall x = wall_x_m, which is canopy.
class FixedScene final : public SceneQuery {
 public:
  double wall_x_m = 1e9;
  double ground_slope = 0.0;

  std::optional<RayHit> cast_ray(const Eigen::Vector3d& p, const Eigen::Vector3d& dir,
                                 double max_distance_m, SurfaceMask mask) const override {
    std::optional<RayHit> nearest;
    const auto consider = [&](double distance, SurfaceClass surface,
                              const Eigen::Vector3d& normal) {
      if (distance < 0.0 || distance > max_distance_m || !(mask & mask_of(surface))) return;
      if (!nearest || distance < nearest->distance_m)
        nearest = RayHit{distance, normal, surface, -1};
    };
    const double sinking = ground_slope * dir.x() - dir.z();
    if (sinking > 0.0) {
      consider((p.z() - ground_slope * p.x()) / sinking, SurfaceClass::kTerrain,
               Eigen::Vector3d(-ground_slope, 0.0, 1.0).normalized());
    }
    if (dir.x() > 0.0)
      consider((wall_x_m - p.x()) / dir.x(), SurfaceClass::kCanopy, -Eigen::Vector3d::UnitX());
    return nearest;
  }
  std::optional<double> ground_height_m(double x, double, double) const override {
    return ground_slope * x;
  }
  double distance_to_box_m(const Pose&, const Eigen::Vector3d&, double max_distance_m,
                           SurfaceMask) const override {
    return max_distance_m;
  }
};

/// Only tells the specific force, the velocity through the air, and the states of one steered axle
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
  FixedScene scene;
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
