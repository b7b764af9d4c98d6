#pragma once
/// Rover of paper B as a pure kinematic model, without forces and therefore without wind.
///
/// Actuators, signals and frame as of DiffDriveRover. It moves by the mean speed of each side's
/// wheels, which turn as commanded: their speeds are the actuator states. Rolling resistance drains
/// the battery; once it is empty, the wheels stand.

#include <array>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/sensors.h"
#include "vehicles/diff_drive_rover/diff_drive_rover_params.h"
#include "vehicles/parts/kinematic_platform.h"
#include "vehicles/parts/link_shelf.h"

namespace vinerow::vehicles {

class KinematicRover final : public Vehicle {
 public:
  /// @throws ConfigError
  explicit KinematicRover(const DiffDriveRoverParams& params, const LinkShelf& links = {});

  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld& world, const Pose& X_WB) override;
  void connect(Ports& ports) override;
  void actuate(std::span<const double> values) override;
  void before_physics(Time now, Duration dt) override;
  void after_physics(Time now, Duration dt) override;
  void read_truth(Odometry& truth) const override { platform_.read_truth(truth); }
  Eigen::Vector3d specific_force_B() const override { return platform_.state().specific_force_B; }
  std::span<const double> actuator_states() const override { return wheels_message_.values; }
  void read_links(std::vector<Pose>& X_WL) const override;
  void publish(Time now) override;

 private:
  DiffDriveRoverParams params_;
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  KinematicPlatform platform_;
  std::array<double, 4> angle_rad_{};
  BatteryState battery_;
  bool powered_ = true, reported_empty_ = false;
  NamedValues wheels_message_;
  SignalWriter<NamedValues> wheels_writer_;
  SignalWriter<BatteryState> battery_writer_;
  SignalWriter<Event> event_writer_;
  physics::PhysicsWorld* world_ = nullptr;
};

}  // namespace vinerow::vehicles
