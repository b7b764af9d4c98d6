#include "vehicles/diff_drive_rover/diff_drive_rover.h"

#include "vehicles/diff_drive_rover/kinematic_rover.h"
#include "vehicles/diff_drive_rover/rover_mesh.h"
#include "vehicles/parts/effective_track.h"
#include "vehicles/parts/wheel_mesh.h"

namespace vinerow::vehicles {

DiffDriveRover::DiffDriveRover(const DiffDriveRoverParams& params, double gravity_mps2,
                               const LinkShelf& links) {
  params.validate();
  description_ = describe_diff_drive_rover(params);
  links_ = links.get([&] { return make_diff_drive_links(params); });
  WheeledPlatformParams platform = chassis_platform_params(params, gravity_mps2);
  platform.shapes = {make_diff_drive_shape(description_)};
  build_platform(std::move(platform));
}

VehicleDescription describe_diff_drive_rover(const DiffDriveRoverParams& params) {
  // The hull as a box above the ground. What is lower is met by the wheels.
  constexpr double kHullBottom_m = 0.22;
  constexpr double kHullTop_m = 0.82;
  VehicleDescription description;
  description.type = "diff_drive_rover";
  describe_chassis(params, kHullBottom_m, kHullTop_m, description);
  description.wheeled->effective_track_m =
      calc_effective_track_m(params.track_m, params.wheel_base_m);
  description.max_speed_mps = params.max_speed_mps;
  description.min_turning_radius_m = params.min_turning_radius_m;
  return description;
}

physics::PlacedShape make_diff_drive_shape(const VehicleDescription& description) {
  return {physics::BoxShape{description.collision_half_extents_m},
          Pose{Eigen::Quaterniond::Identity(), description.collision_centre_B}};
}

std::vector<VehicleLink> make_diff_drive_links(const DiffDriveRoverParams& params) {
  std::vector<VehicleLink> links;
  Material material;
  material.name = "rover";
  material.colour = {1.0f, 1.0f, 1.0f};  // the meshes carry their colours
  material.roughness = 0.6f;
  links.push_back({"body", std::make_shared<TriangleMesh>(make_rover_mesh(params)), material});
  WheelMeshParams wheel;
  wheel.radius_m = params.wheel_radius_m;
  wheel.width_m = params.tyre_width_m;
  wheel.rim_radius_m = 0.53 * params.wheel_radius_m;
  wheel.lug_height_m = 0.08 * params.wheel_radius_m;
  material.roughness = 0.9f;
  append_wheel_links(wheel, material, links);
  return links;
}

std::unique_ptr<Vehicle> make_diff_drive_rover(const ParameterSet& parameters,
                                               const VehicleContext& context) {
  const DiffDriveRoverParams params = read_diff_drive_rover_params(parameters, context.vehicle);
  const LinkShelf links(parameters, context);
  if (params.kinematic) return std::make_unique<KinematicRover>(params, links);
  auto rover = std::make_unique<DiffDriveRover>(params, context.gravity_mps2, links);
  rover->feel_wind(context.random("wind"));
  return rover;
}

}  // namespace vinerow::vehicles
