#pragma once
/// A vehicle whose mechanics are one WheeledPlatform: what all of them do alike.
///
/// A vehicle class fills description_ and links_, calls build_platform() in its constructor, and
/// overrides what it does otherwise. Here the actuators are the driven wheels' speeds in the
/// platform's order, and the links the body, then the wheels; further links stand behind them.

#include <optional>

#include "vehicles/parts/wheeled_platform.h"

namespace vinerow::vehicles {

class PlatformVehicle : public Vehicle {
 public:
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld& world, const Pose& X_WB) override;
  /// Signals "wheels" and "battery".
  void connect(Ports& ports) override;
  void actuate(std::span<const double> values) override;
  void before_physics(Time now, Duration dt) override;
  void after_physics(Time now, Duration dt) override;
  void read_truth(Odometry& truth) const override;
  Eigen::Vector3d specific_force_B() const override;
  std::span<const double> actuator_states() const override { return actuator_states_; }
  void read_links(std::vector<Pose>& X_WL) const override;
  void publish(Time now) override;

  /// For factories: lets the wind push (WheeledPlatform::feel_wind). A vehicle without platform,
  /// of kinematic fidelity, goes its way in any wind.
  void feel_wind(RandomStream random) {
    if (platform_) platform_->feel_wind(random);
  }
  /// Not without build_platform().
  const WheeledPlatform& platform() const { return *platform_; }

 protected:
  /// @param driven  places of the wheels that have an actuator, ascending; empty: all
  /// @throws ConfigError
  void build_platform(WheeledPlatformParams params, std::vector<std::size_t> driven = {});

  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  std::optional<WheeledPlatform> platform_;
  std::vector<std::size_t> driven_;      ///< wheels with an actuator, whose place is the same
  std::vector<double> actuator_states_;  ///< written after each step
};

}  // namespace vinerow::vehicles
