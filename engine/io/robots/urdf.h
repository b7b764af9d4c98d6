#pragma once
/// Reader of URDF robots as plain data, based on liburdfdom. Lengths in metres, angles in radians.
///
/// A xacro source is expanded first by the program `xacro`, if installed. Beyond plain URDF, a
/// remaining `$(optenv NAME default)` is replaced by its default; the environment is ignored, since
/// a run must not depend on it. `package://name/rest` is looked up in `packages`, else in the
/// nearest parent folder named `name`.

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/pose.h"

namespace vinerow::io {

enum class UrdfShapeKind { kBox, kCylinder, kSphere, kMesh };

/// A visual or collision element.
struct UrdfShape {
  UrdfShapeKind kind = UrdfShapeKind::kBox;
  Pose X_LS;                                         ///< in its link's frame
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< box: full edges
  double radius_m = 0.0;                             ///< cylinder, sphere
  double length_m = 0.0;                             ///< cylinder, along z of S
  std::filesystem::path mesh_file;                   ///< absolute, exists
  Eigen::Vector3d mesh_scale = Eigen::Vector3d::Ones();
  std::optional<Eigen::Vector3f> colour;  ///< of the material, sRGB 0..1, if given
};

struct UrdfLink {
  std::string name;
  double mass_kg = 0.0;  ///< 0 without <inertial>
  Eigen::Vector3d com_L = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia_L = Eigen::Matrix3d::Zero();  ///< about the centre of mass, axes of L
  std::vector<UrdfShape> visuals;
  std::vector<UrdfShape> collisions;
  int parent_joint = -1;  ///< index into UrdfModel::joints; -1: the root
};

/// Limits of a joint's position and speed: rad and rad/s, or m and m/s for sliding joints.
struct UrdfLimits {
  double lower = 0.0;
  double upper = 0.0;
  double velocity = 0.0;  ///< 0: not given
};

enum class UrdfJointKind { kFixed, kContinuous, kRevolute, kPrismatic, kFloating, kPlanar };

struct UrdfJoint {
  std::string name;
  UrdfJointKind kind = UrdfJointKind::kFixed;
  int parent_link = -1;
  int child_link = -1;
  Pose X_PJ;  ///< child's frame in the parent's, at joint position zero
  Eigen::Vector3d axis_J = Eigen::Vector3d::UnitX();  ///< unit, in the child's frame
  std::optional<UrdfLimits> limits;
};

struct UrdfModel {
  std::string name;
  std::filesystem::path file;
  std::vector<UrdfLink> links;     ///< parents before children; [0] is the root
  std::vector<UrdfJoint> joints;   ///< joint i leads to links[i + 1]
  std::vector<std::string> notes;  ///< replaced or ignored elements
};

/// @param packages  folder of each `package://` name
/// @throws ConfigError in one sentence: the file does not exist, is not well-formed XML (with the
///         line), is not a URDF (with the parser's reason), names a missing mesh, or is a xacro
///         source that cannot be expanded
UrdfModel load_urdf(const std::filesystem::path& file,
                    const std::map<std::string, std::filesystem::path>& packages = {});

}  // namespace vinerow::io
