#pragma once
/// Base class of vehicles whose mechanics are one WheeledPlatform.
///
/// A derived class fills description_ and links_, calls build_platform() in its constructor, and
/// overrides the methods in which it differs. Actuators are the speeds of the driven wheels in the
/// order of the platform. Links are the body, the wheels, and then any further links.

#include <optional>

#include "engine/api/messages/event.h"
#include "vehicles/parts/wheeled_platform.h"

namespace vinerow::vehicles {

class PlatformVehicle : public Vehicle {
 public:
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld& world, const Pose& X_WB) override;
  /// Signals "wheels", "battery" and "vehicle_event".
  void connect(Ports& ports) override;
  void actuate(std::span<const double> values) override;
  void before_physics(Time now, Duration dt) override;
  void after_physics(Time now, Duration dt) override;
  void read_truth(Odometry& truth) const override;
  Eigen::Vector3d specific_force_B() const override;
  Eigen::Vector3d air_velocity_B() const override;
  std::span<const double> actuator_states() const override { return actuator_states_; }
  void read_links(std::vector<Pose>& X_WL) const override;
  void publish(Time now) override;

  /// For factories: enables wind forces (WheeledPlatform::feel_wind). @pre build_platform() was
  /// called
  void feel_wind(RandomStream random) { platform_->feel_wind(random); }
  /// @pre build_platform() was called
  const WheeledPlatform& platform() const { return *platform_; }

 protected:
  /// @param driven  indices of the wheels that have an actuator, ascending; empty: all
  /// @throws ConfigError
  void build_platform(WheeledPlatformParams params, std::vector<std::size_t> driven = {});

  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  std::optional<WheeledPlatform> platform_;
  std::vector<std::size_t> driven_;      ///< wheel of each actuator
  std::vector<double> actuator_states_;  ///< written after each step
  std::string note_;                     ///< about its files, for the user: an event at its start

 private:
  bool reported_empty_ = false;
  SignalWriter<Event> event_writer_;
};

}  // namespace vinerow::vehicles
