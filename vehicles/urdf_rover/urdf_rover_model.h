#pragma once
/// Rover model of a URDF robot: one rigid body, its wheels, their steering, its meshes.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/vehicle.h"
#include "engine/io/robots/urdf.h"
#include "engine/physics/physics_world.h"

namespace vinerow::vehicles {

struct UrdfWheel {
  std::string joint;
  std::string name;  ///< "fl", "fr", "rl", "rr" with two per side, else "l1", "l2", ..., "r1", ...
  bool left = true;
  Eigen::Vector3d hub_B;  ///< m
  double radius_m = 0.0;
  double half_width_m = 0.0;
  double spin_inertia_kgm2 = 0.0;  ///< about the joint's axis
  int steering_joint = -1;         ///< index into UrdfModel::joints; -1: it does not steer
};

/// Steering of a robot with four wheels of which the front ones, or all, have steering joints.
struct UrdfSteering {
  std::size_t axles = 1;                      ///< 1: the front one, 2: both
  double front_m = 0.0;                       ///< front axle ahead of B
  double rear_m = 0.0;                        ///< rear axle behind B
  std::optional<double> max_wheel_steer_rad;  ///< smallest of the joints' limits, if any
};

/// Frame B: origin at the centre of mass of everything, axes of the URDF's root link.
struct UrdfRoverModel {
  double mass_kg = 0.0;
  Eigen::Matrix3d inertia_B = Eigen::Matrix3d::Zero();  ///< of everything, wheels included
  Eigen::Vector3d com_root = Eigen::Vector3d::Zero();   ///< B's origin in the root link's frame
  std::vector<UrdfWheel> wheels;             ///< left ones first, each side from front to rear
  std::vector<physics::PlacedShape> shapes;  ///< of the body, without wheels
  Eigen::AlignedBox3d bounds_B;              ///< of body and wheels
  /// "body", the wheels in their order, drawn knuckles of those that steer.
  std::vector<VehicleLink> links;
  std::vector<std::size_t> knuckles;  ///< wheels of the last links
  double track_m = 0.0;
  double wheel_base_m = 0.0;
  double height_above_ground_m = 0.0;    ///< of B, with the wheels' lowest points on the ground
  std::optional<UrdfSteering> steering;  ///< none: it steers by its wheels' speeds
  std::vector<std::string> notes;        ///< the file's, and doubts about units
};

/// How to read the robot.
struct UrdfRoverOptions {
  std::vector<std::string> left_joints, right_joints;  ///< empty: continuous joints by position
  /// Empty: joints that carry a wheel and turn about the vertical through its hub.
  std::vector<std::string> steering_joints;
  std::optional<double> wheel_radius_m;  ///< absent: from collision shape or mesh
};

/// Reads the robot. Everything that neither rolls nor steers becomes one rigid body with all joints
/// at zero. It includes the masses of the wheels; their spin inertia is kept.
/// @throws ConfigError: no wheel joints, unknown joint, axle not across, no radius, no mass, a
/// castor, steered wheels that are neither the two front ones nor all of four
UrdfRoverModel read_urdf_rover(const io::UrdfModel& urdf, const UrdfRoverOptions& options);

}  // namespace vinerow::vehicles
