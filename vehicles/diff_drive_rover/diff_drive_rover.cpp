#include "vehicles/diff_drive_rover/diff_drive_rover.h"

#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/math/angles.h"
#include "vehicles/diff_drive_rover/rover_mesh.h"
#include "vehicles/parts/effective_track.h"
#include "vehicles/parts/wheel_mesh.h"

namespace vinerow::vehicles {
namespace {

/// The hull as a box above the ground: lower and upper edge. What is lower is met by the wheels.
constexpr double kHullBottom_m = 0.22;
constexpr double kHullTop_m = 0.82;

}  // namespace

WheeledPlatformParams diff_drive_platform_params(const DiffDriveRoverParams& p,
                                                 double gravity_mps2) {
  return chassis_platform_params(p, gravity_mps2);
}

DiffDriveRover::DiffDriveRover(const DiffDriveRoverParams& params, double gravity_mps2)
    : params_(params) {
  params_.validate();
  describe();
  make_links();
  WheeledPlatformParams platform = diff_drive_platform_params(params_, gravity_mps2);
  platform.shapes = {{physics::BoxShape{description_.collision_half_extents_m},
                      Pose{Eigen::Quaterniond::Identity(), description_.collision_centre_B}}};
  if (!params_.kinematic) {
    build_platform(std::move(platform));
    return;
  }
  KinematicPlatformParams kinematic;
  kinematic.name = params_.name;
  kinematic.mass_kg = params_.mass_kg;
  kinematic.inertia_B = platform.inertia_B;
  kinematic.shapes = platform.shapes;
  kinematic.track_m = params_.track_m;
  kinematic.wheel_base_m = params_.wheel_base_m;
  kinematic.height_above_ground_m = params_.com_height_m;
  kinematic_.emplace(std::move(kinematic));
  for (const ActuatorSpec& actuator : description_.actuators) {
    wheels_message_.names.push_back(actuator.name);
  }
  actuator_states_.assign(kCorners.size(), 0.0);
}

void DiffDriveRover::describe() {
  const DiffDriveRoverParams& p = params_;
  description_.type = "diff_drive_rover";
  append_wheel_speed_actuators(p, description_.actuators);
  description_.mass_kg = p.mass_kg;
  description_.height_above_ground_m = p.com_height_m;
  description_.collision_half_extents_m = {0.5 * p.wheel_base_m + p.wheel_radius_m,
                                           0.5 * (p.track_m + p.tyre_width_m),
                                           0.5 * (kHullTop_m - kHullBottom_m)};
  description_.collision_centre_B = {0.0, 0.0, 0.5 * (kHullTop_m + kHullBottom_m) - p.com_height_m};
  WheeledVehicle& wheeled = description_.wheeled.emplace();
  wheeled.track_m = p.track_m;
  wheeled.wheel_base_m = p.wheel_base_m;
  wheeled.wheel_radius_m = p.wheel_radius_m;
  wheeled.wheel_speed_limit_radps = p.wheel_speed_limit_radps;
  wheeled.effective_track_m =
      p.kinematic ? p.track_m : calc_effective_track_m(p.track_m, p.wheel_base_m);
  description_.max_speed_mps = p.max_speed_mps;
  description_.min_turning_radius_m = p.min_turning_radius_m;
}

void DiffDriveRover::make_links() {
  RoverMeshParams body;
  body.wheel_base_m = params_.wheel_base_m;
  body.track_m = params_.track_m;
  body.wheel_radius_m = params_.wheel_radius_m;
  body.tyre_width_m = params_.tyre_width_m;
  body.ground_to_origin_m = params_.com_height_m;
  Material material;
  material.name = "rover";
  material.colour = {1.0f, 1.0f, 1.0f};  // the meshes carry their colours
  material.roughness = 0.6f;
  links_.push_back({"body", std::make_shared<TriangleMesh>(make_rover_mesh(body)), material});
  WheelMeshParams wheel;
  wheel.radius_m = params_.wheel_radius_m;
  wheel.width_m = params_.tyre_width_m;
  wheel.rim_radius_m = 0.53 * params_.wheel_radius_m;
  wheel.lug_height_m = 0.08 * params_.wheel_radius_m;
  material.roughness = 0.9f;
  append_wheel_links(wheel, material, links_);
}

void DiffDriveRover::spawn(physics::PhysicsWorld& world, const Pose& X_WB) {
  world_ = &world;
  if (!kinematic_) return PlatformVehicle::spawn(world, X_WB);
  kinematic_->spawn(world, X_WB);
}

void DiffDriveRover::connect(Ports& ports) {
  if (!kinematic_) return PlatformVehicle::connect(ports);
  wheels_writer_ = ports.write<NamedValues>("wheels");
  battery_writer_ = ports.write<BatteryState>("battery");
}

void DiffDriveRover::actuate(std::span<const double> values) {
  if (!kinematic_) return PlatformVehicle::actuate(values);
  VINEROW_ASSERT(values.size() == kCorners.size());
  std::copy(values.begin(), values.end(), actuator_states_.begin());
  kinematic_->command(0.5 * (values[0] + values[2]) * params_.wheel_radius_m,
                      0.5 * (values[1] + values[3]) * params_.wheel_radius_m);
}

void DiffDriveRover::before_physics(Time now, Duration dt) {
  if (!kinematic_) return PlatformVehicle::before_physics(now, dt);
  kinematic_->before_physics(dt);
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    angle_rad_[i] = wrap_angle(angle_rad_[i] + actuator_states_[i] * dt.s());
  }
  const double resistance_N = world_->world_model().soil.rolling_resistance * params_.mass_kg *
                              world_->settings().gravity_mps2;
  const double drive_W = resistance_N * std::abs(kinematic_->state().planar.v_mps);
  advance_battery(params_.battery, drive_W / params_.motor.efficiency, dt.s(), battery_);
}

void DiffDriveRover::after_physics(Time now, Duration dt) {
  if (!kinematic_) PlatformVehicle::after_physics(now, dt);
}

void DiffDriveRover::read_truth(Odometry& truth) const {
  if (!kinematic_) return PlatformVehicle::read_truth(truth);
  kinematic_->read_truth(truth);
}

Eigen::Vector3d DiffDriveRover::specific_force_B() const {
  return kinematic_ ? kinematic_->state().specific_force_B : PlatformVehicle::specific_force_B();
}

void DiffDriveRover::read_links(std::vector<Pose>& X_WL) const {
  if (!kinematic_) return PlatformVehicle::read_links(X_WL);
  X_WL[0] = kinematic_->state().body.X_WB;
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    const Eigen::AngleAxisd turned(angle_rad_[i], Eigen::Vector3d::UnitY());
    X_WL[i + 1] = X_WL[0] * Pose{Eigen::Quaterniond(turned), params_.hub_B(kCorners[i])};
  }
}

void DiffDriveRover::publish(Time now) {
  if (!kinematic_) return PlatformVehicle::publish(now);
  wheels_message_.values = actuator_states_;
  if (wheels_writer_.connected()) wheels_writer_.write(now, wheels_message_);
  if (battery_writer_.connected()) battery_writer_.write(now, battery_);
}

std::unique_ptr<Vehicle> make_diff_drive_rover(const ParameterSet& parameters,
                                               const VehicleContext& context) {
  auto rover = std::make_unique<DiffDriveRover>(
      read_diff_drive_rover_params(parameters, context.vehicle), context.gravity_mps2);
  rover->feel_wind(context.random("wind"));
  return rover;
}

}  // namespace vinerow::vehicles
