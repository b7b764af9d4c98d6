#pragma once
/// Extension point Vehicle: bodies, wheels or rotors in the physics world, driven by a vector of
/// named actuators.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/messages/motion.h"
#include "engine/api/part.h"
#include "engine/api/surface.h"
#include "engine/api/vehicle_kinds.h"

namespace vinerow {

namespace physics {
class PhysicsWorld;
}

/// One entry of the actuator vector. Names carry their unit: "wheel_fl_speed_radps".
struct ActuatorSpec {
  std::string name;
  std::string unit;
  double min = 0.0;
  double max = 0.0;
};

/// Static description of a vehicle, available to controllers, guidance, sensors and metrics.
/// Constant after building.
struct VehicleDescription {
  std::string type;
  std::vector<ActuatorSpec> actuators;
  double mass_kg = 0.0;
  Eigen::Vector3d collision_centre_B = Eigen::Vector3d::Zero();  ///< of the box around the hull, m
  Eigen::Vector3d collision_half_extents_m = {0.5, 0.5, 0.5};
  /// Outline seen from above, wheels included: convex, counter-clockwise, in B's plane, m. If
  /// empty, the collision box counts.
  std::vector<Eigen::Vector2d> footprint_B;
  double height_above_ground_m = 0.0;  ///< of B's origin when the vehicle stands on level ground
  /// Maximum speed, m/s; for winged vehicles through the air. Absent: unknown.
  std::optional<double> max_speed_mps;
  /// Radius of the path of B's origin seen from above, m; 0: the vehicle turns on the spot. Absent:
  /// unknown.
  std::optional<double> min_turning_radius_m;
  std::optional<double> battery_capacity_J;  ///< when full. Absent: unknown

  /// Capabilities, see vehicle_kinds.h. At least one is present; each one that is present is
  /// complete.
  std::optional<WheeledVehicle> wheeled;
  std::optional<SteeredVehicle> steered;      ///< only with `wheeled`
  std::optional<AckermannVehicle> ackermann;  ///< only with `wheeled`, not with `steered`
  std::optional<Rotorcraft> rotorcraft;
  std::optional<FixedWingAircraft> fixed_wing;

  bool flies() const { return rotorcraft.has_value() || fixed_wing.has_value(); }
  /// True if the vehicle drives by steering angles and cannot turn on the spot.
  bool steers_by_axles() const { return steered.has_value() || ackermann.has_value(); }

  /// Record that a part requires.
  /// @param who  part that needs it, "rover.controller (pure_pursuit)"
  /// @throws ConfigError "rover.controller (pure_pursuit) needs a vehicle with wheels; vehicle type
  /// 'quadrotor' has rotors"
  const WheeledVehicle& need_wheeled(const std::string& who) const;
  const SteeredVehicle& need_steered(const std::string& who) const;
  const AckermannVehicle& need_ackermann(const std::string& who) const;
  const Rotorcraft& need_rotorcraft(const std::string& who) const;
  const FixedWingAircraft& need_fixed_wing(const std::string& who) const;
  /// Number that a part requires. @param name  of the field, "min_turning_radius_m"
  /// @returns the value
  /// @throws ConfigError "rover.planner (coverage) needs 'min_turning_radius_m', which vehicle type
  /// 'x' does not have"
  double need(const std::optional<double>& value, const char* name, const std::string& who) const;
  /// Number that must be finite and above 0. @returns the value
  /// @throws ConfigError "rover.controller (dwa) needs 'front_axle_m' > 0, but vehicle type 'x' has
  /// -0.75"
  double need_positive(double value, const char* name, const std::string& who) const;

  /// The footprint; without one the outline of the collision box.
  std::vector<Eigen::Vector2d> outline_B() const;
  /// Index of an actuator. @throws ConfigError that names the vehicle's actuators and the nearest
  /// name
  int actuator_index(const std::string& name, const std::string& who) const;
};

/// Drawable link. Its pose is in the LinkPoses signal, in the same order.
struct VehicleLink {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;
  Material material;
};

class Vehicle {
 public:
  virtual ~Vehicle() = default;

  virtual const VehicleDescription& description() const = 0;
  virtual const std::vector<VehicleLink>& links() const = 0;

  /// Creates the bodies on the ground. @param X_WB pose of B at the start
  virtual void spawn(physics::PhysicsWorld& world, const Pose& X_WB) = 0;

  /// Connects the vehicle's further signals (wheel states, battery). The kernel itself writes
  /// "truth", "links" and "actuators".
  virtual void connect(Ports& ports) = 0;

  /// Sets the actuator vector, which holds until the next call. Values are already limited to the
  /// specs.
  /// @param values  description().actuators.size() entries
  virtual void actuate(std::span<const double> values) = 0;

  /// Applies the forces of the coming physics step. @param now start of the step
  virtual void before_physics(Time now, Duration dt) = 0;
  /// Reads the bodies after the step and advances the vehicle's own states. @param now end of the
  /// step
  virtual void after_physics(Time now, Duration dt) = 0;

  /// True pose and twist of B.
  virtual void read_truth(Odometry& truth) const = 0;
  /// Specific force at B's origin in B (acceleration minus gravity), mean over the last step, m/s2.
  virtual Eigen::Vector3d specific_force_B() const = 0;
  /// True actuator values for encoders, in the order and units of description().actuators. Empty if
  /// the vehicle does not model them.
  virtual std::span<const double> actuator_states() const { return {}; }
  /// True velocity of B's origin through the air, in B, m/s, for air data sensors. For a vehicle
  /// without wind the velocity over ground.
  virtual Eigen::Vector3d air_velocity_B() const {
    Odometry truth;
    read_truth(truth);
    return truth.v_WB_B;
  }
  /// Reason of a crash, "hit the ground at 2.3 m/s"; empty if there was none. Once set it stays.
  /// The kernel reports it as an event, and ends or fails the run according to the scenario's
  /// `on_crash`.
  virtual std::string_view crash() const { return {}; }
  /// Fills the poses in the order of links(); the vectors already have their size.
  virtual void read_links(std::vector<Pose>& X_WL) const = 0;
  /// Writes the vehicle's own signals; called at the rate at which the sense stage writes the
  /// truth.
  virtual void publish(Time now) = 0;
};

}  // namespace vinerow
