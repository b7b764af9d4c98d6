#pragma once
/// Rover of paper B: four driven wheels and skid steering.
///
/// Actuators: wheel_fl_speed_radps, wheel_fr_..., wheel_rl_..., wheel_rr_..., positive forward.
/// Kinematic fidelity uses the mean of each side. Signals: "wheels" (NamedValues), "battery".
/// B: centre of mass, in the middle between the wheels, com_height_m above level ground.

#include <memory>
#include <optional>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/registry.h"
#include "vehicles/diff_drive_rover/diff_drive_rover_params.h"
#include "vehicles/parts/kinematic_platform.h"
#include "vehicles/parts/platform_vehicle.h"

namespace vinerow::vehicles {

/// Body, wheels and battery of the rover, without collision shapes.
WheeledPlatformParams diff_drive_platform_params(const DiffDriveRoverParams& params,
                                                 double gravity_mps2 = 9.80665);

class DiffDriveRover final : public PlatformVehicle {
 public:
  /// @throws ConfigError
  explicit DiffDriveRover(const DiffDriveRoverParams& params, double gravity_mps2 = 9.80665);

  void spawn(physics::PhysicsWorld& world, const Pose& X_WB) override;
  void connect(Ports& ports) override;
  void actuate(std::span<const double> values) override;
  void before_physics(Time now, Duration dt) override;
  void after_physics(Time now, Duration dt) override;
  void read_truth(Odometry& truth) const override;
  Eigen::Vector3d specific_force_B() const override;
  void read_links(std::vector<Pose>& X_WL) const override;
  void publish(Time now) override;

 private:
  void describe();
  void make_links();

  DiffDriveRoverParams params_;
  // Kinematic fidelity: replaces the platform. The wheels turn as commanded (their speeds are the
  // actuator states), and rolling resistance drains the battery.
  std::optional<KinematicPlatform> kinematic_;
  std::array<double, 4> angle_rad_{};
  BatteryState battery_;
  NamedValues wheels_message_;
  SignalWriter<NamedValues> wheels_writer_;
  SignalWriter<BatteryState> battery_writer_;
  physics::PhysicsWorld* world_ = nullptr;
};

std::unique_ptr<Vehicle> make_diff_drive_rover(const ParameterSet& parameters,
                                               const VehicleContext& context);

}  // namespace vinerow::vehicles
