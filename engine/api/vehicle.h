#pragma once
/// Extension point Vehicle: bodies, wheels or rotors in the physics world, driven by a named
/// actuator vector.

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

/// What a vehicle tells controllers, guidance, sensors and metrics about itself. Constant after
/// building.
struct VehicleDescription {
  std::string type;
  std::vector<ActuatorSpec> actuators;
  double mass_kg = 0.0;
  Eigen::Vector3d collision_centre_B = Eigen::Vector3d::Zero();  ///< of the box around the hull, m
  Eigen::Vector3d collision_half_extents_m = {0.5, 0.5, 0.5};
  /// Outline seen from above, wheels included: convex, counter-clockwise, in B's plane, m. Empty:
  /// the collision box.
  std::vector<Eigen::Vector2d> footprint_B;
  double height_above_ground_m = 0.0;  ///< of B's origin when standing on level ground
  /// Fastest that it drives or flies, m/s; with wings through the air. Absent: not known.
  std::optional<double> max_speed_mps;
  /// Of the way of B's origin seen from above, m; 0: it turns on the spot. Absent: not known.
  std::optional<double> min_turning_radius_m;
  std::optional<double> battery_capacity_J;  ///< when full. Absent: not known

  /// What it has; see vehicle_kinds.h. At least one, and each that is there is filled whole.
  std::optional<WheeledVehicle> wheeled;
  std::optional<SteeredVehicle> steered;      ///< only with `wheeled`
  std::optional<AckermannVehicle> ackermann;  ///< only with `wheeled`, not with `steered`
  std::optional<Rotorcraft> rotorcraft;
  std::optional<FixedWingAircraft> fixed_wing;

  bool flies() const { return rotorcraft.has_value() || fixed_wing.has_value(); }
  /// Drives by steering angles and cannot turn on the spot.
  bool steers_by_axles() const { return steered.has_value() || ackermann.has_value(); }

  /// The record a part cannot do without.
  /// @param who  part that asks, "rover.controller (pure_pursuit)"
  /// @throws ConfigError "rover.controller (pure_pursuit) needs a vehicle with wheels; vehicle type
  /// 'quadrotor' has rotors"
  const WheeledVehicle& need_wheeled(const std::string& who) const;
  const SteeredVehicle& need_steered(const std::string& who) const;
  const AckermannVehicle& need_ackermann(const std::string& who) const;
  const Rotorcraft& need_rotorcraft(const std::string& who) const;
  const FixedWingAircraft& need_fixed_wing(const std::string& who) const;
  /// A number a part cannot do without. @param name  of its field, "min_turning_radius_m"
  /// @returns the value
  /// @throws ConfigError "rover.planner (coverage) needs 'min_turning_radius_m', which vehicle type
  /// 'x' does not have"
  double need(const std::optional<double>& value, const char* name, const std::string& who) const;
  /// A number that must be above 0 and finite. @returns the value
  /// @throws ConfigError "rover.controller (dwa) needs 'front_axle_m' > 0, but vehicle type 'x'
  /// has -0.75"
  double need_positive(double value, const char* name, const std::string& who) const;

  /// The footprint; the collision box's where none is given.
  std::vector<Eigen::Vector2d> outline_B() const;
  /// Index of an actuator. @throws ConfigError naming the actuators the vehicle has and the
  /// nearest.
  int actuator_index(const std::string& name, const std::string& who) const;
};

/// A drawable link. Its pose comes with the LinkPoses signal, same order.
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

  /// Creates the bodies, standing on the ground. @param X_WB pose of B at the start.
  virtual void spawn(physics::PhysicsWorld& world, const Pose& X_WB) = 0;

  /// Further signals of its own (wheel states, battery). The kernel itself writes "truth", "links"
  /// and "actuators".
  virtual void connect(Ports& ports) = 0;

  /// Takes over the actuator vector; it holds until the next call. Values are already limited to
  /// the specs.
  /// @param values  description().actuators.size() entries
  virtual void actuate(std::span<const double> values) = 0;

  /// Forces of the coming physics step. @param now start of the step
  virtual void before_physics(Time now, Duration dt) = 0;
  /// After the step: reads the bodies, advances own states. @param now end of the step
  virtual void after_physics(Time now, Duration dt) = 0;

  /// True pose and twist of B.
  virtual void read_truth(Odometry& truth) const = 0;
  /// Specific force at B's origin in B (acceleration minus gravity), mean over the last step, m/s2.
  virtual Eigen::Vector3d specific_force_B() const = 0;
  /// What encoders on the actuators would tell: the true value of each, same order and units as
  /// description().actuators. Empty where the vehicle does not know.
  virtual std::span<const double> actuator_states() const { return {}; }
  /// True velocity through the air of B's origin, in B, m/s; of a vehicle that feels no wind its
  /// velocity over ground. What an air data sensor measures.
  virtual Eigen::Vector3d air_velocity_B() const {
    Odometry truth;
    read_truth(truth);
    return truth.v_WB_B;
  }
  /// Why the vehicle is wrecked, "hit the ground at 2.3 m/s"; empty while it is not. Once told it
  /// stays. The kernel tells people, and ends or fails the run as the scenario's `on_crash` says.
  virtual std::string_view crash() const { return {}; }
  /// Fills poses, same order as links(); the vectors have their size already.
  virtual void read_links(std::vector<Pose>& X_WL) const = 0;
  /// Writes own signals; called at the rate of the sense stage's truth.
  virtual void publish(Time now) = 0;
};

}  // namespace vinerow
