#pragma once
/// What a URDF robot is as a skid-steered rover: one rigid body, its wheels, its pictures.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/vehicle.h"
#include "engine/io/urdf.h"
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
};

/// Frame B: origin at the centre of mass of everything, axes of the URDF's root link.
struct UrdfRoverModel {
  double mass_kg = 0.0;
  Eigen::Matrix3d inertia_B = Eigen::Matrix3d::Zero();  ///< of everything, wheels included
  Eigen::Vector3d com_root = Eigen::Vector3d::Zero();   ///< B's origin in the root link's frame
  std::vector<UrdfWheel> wheels;             ///< left ones first, each side from front to rear
  std::vector<physics::PlacedShape> shapes;  ///< of the body, without wheels
  Eigen::AlignedBox3d bounds_B;              ///< of body and wheels
  std::vector<VehicleLink> links;            ///< "body", then the wheels in their order
  double track_m = 0.0;
  double wheel_base_m = 0.0;
  double height_above_ground_m = 0.0;  ///< of B, with the wheels' lowest points on the ground
};

/// How to read the robot.
struct UrdfRoverOptions {
  std::vector<std::string> left_joints, right_joints;  ///< empty: continuous joints by position
  std::optional<double> wheel_radius_m;                ///< absent: from collision shape or mesh
};

/// Everything that does not roll is taken as one rigid body with all joints at zero. The wheels'
/// masses belong to it too (their suspension has no mass of its own); their spin inertia is kept.
/// @throws ConfigError: no wheel joints, unknown joint, axle not across, no radius, no mass
UrdfRoverModel read_urdf_rover(const io::UrdfModel& urdf, const UrdfRoverOptions& options);

}  // namespace vinerow::vehicles
