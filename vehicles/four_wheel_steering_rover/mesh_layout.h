#pragma once
/// Layout and colours of the four-wheel-steering rover's meshes.

#include "engine/math/angles.h"
#include "vehicles/parts/chassis.h"
#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {

namespace livery {
inline constexpr unsigned kOrange = 0xd8571a;
inline constexpr unsigned kDarkOrange = 0x9c3a10;
inline constexpr unsigned kAnthracite = 0x33373b;
inline constexpr unsigned kBlack = 0x17181a;
inline constexpr unsigned kAluminium = 0xb4b8bc;
inline constexpr unsigned kTank = 0xe9ece4;
inline constexpr unsigned kBlue = 0x1f5f9e;
inline constexpr unsigned kGlass = 0x16263f;
inline constexpr unsigned kYellow = 0xf2c230;
inline constexpr unsigned kRed = 0xc62828;
inline constexpr unsigned kLamp = 0xfff3c8;
inline constexpr unsigned kCream = 0xf7f8f4;
}  // namespace livery

/// Heights above the ground, in wheel radii if they depend on the wheels.
struct MeshLayout {
  double half_base, half_track, radius, tyre, ground;

  explicit MeshLayout(const ChassisParams& p)
      : half_base(0.5 * p.wheel_base_m),
        half_track(0.5 * p.track_m),
        radius(p.wheel_radius_m),
        tyre(p.tyre_width_m),
        ground(p.com_height_m) {}

  /// Middle of the portal beams, clear of the mudguards at full spring travel.
  double beam() const { return 2.68 * radius; }
  double deck() const { return beam() + 0.035; }
  /// Frame F at (x, y, z), z from the ground.
  Pose at(double x, double y, double z) const {
    return {Eigen::Quaterniond::Identity(), {x, y, z - ground}};
  }
  /// The same with F's y axis upwards, for upright lathes and cylinders.
  Pose upright(double x, double y, double z) const {
    Pose pose = at(x, y, z);
    pose.q = Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitX());
    return pose;
  }
  /// The same with F's y axis along the direction `yaw` in the plane.
  Pose facing(double x, double y, double z, double yaw_rad) const {
    Pose pose = at(x, y, z);
    pose.q = Eigen::AngleAxisd(yaw_rad - kPi / 2, Eigen::Vector3d::UnitZ());
    return pose;
  }
};

/// Tank, nozzle columns, mast and sensors on the frame.
void add_equipment(const MeshLayout& layout, MeshBuilder& builder);

}  // namespace vinerow::vehicles
