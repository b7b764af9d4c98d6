#include "vehicles/four_wheel_steering_rover/four_wheel_steering_rover.h"

#include <fmt/format.h>

#include "vehicles/four_wheel_steering_rover/four_wheel_steering_mesh.h"

namespace vinerow::vehicles {
namespace {

/// The hull above the ground: lower and upper edge. What is lower is met by the wheels; mast and
/// antenna above it are thin and stay out of the collision shape.
constexpr double kHullBottom_m = 0.24;
constexpr double kHullTop_m = 0.95;
/// How far the noses are narrower than the hull, in wheel radii. The wheels there steer: in the
/// tightest turn the outer front wheel and the hull's shoulder sweep about the same circle.
constexpr double kNoseCut = 0.7;

/// Octagon around hull and wheels, counter-clockwise.
std::vector<Eigen::Vector2d> outline_B(const FourWheelSteeringRoverParams& p) {
  const double half_width = 0.5 * (p.track_m + p.tyre_width_m), shoulder = 0.5 * p.wheel_base_m;
  const double nose = shoulder + p.wheel_radius_m;
  const double nose_width = half_width - kNoseCut * p.wheel_radius_m;
  return {{nose, -nose_width},      {nose, nose_width},     {shoulder, half_width},
          {-shoulder, half_width},  {-nose, nose_width},    {-nose, -nose_width},
          {-shoulder, -half_width}, {shoulder, -half_width}};
}

physics::HullShape hull_shape(const VehicleDescription& about) {
  physics::HullShape hull;
  for (const Eigen::Vector2d& corner : about.footprint_B) {
    for (const double side : {-1.0, 1.0}) {
      hull.points_B.emplace_back(
          corner.x(), corner.y(),
          about.collision_centre_B.z() + side * about.collision_half_extents_m.z());
    }
  }
  return hull;
}

}  // namespace

FourWheelSteeringRover::FourWheelSteeringRover(const FourWheelSteeringRoverParams& params,
                                               double gravity_mps2, const LinkShelf& links)
    : params_(params) {
  params_.validate();
  describe();
  links_ = links.get([&] { return make_links(); });
  WheeledPlatformParams platform = chassis_platform_params(params_, gravity_mps2);
  platform.shapes = {{hull_shape(description_), Pose{}}};
  build_platform(std::move(platform));
}

void FourWheelSteeringRover::describe() {
  const FourWheelSteeringRoverParams& p = params_;
  description_.type = "four_wheel_steering_rover";
  build_steering({.axles = p.axles(),
                  .servo = p.servo,
                  .max_axle_steer_rad = p.max_axle_steer_rad(),
                  .steered_axles = 2,
                  .knuckles = {0, 1, 2, 3}});
  describe_chassis(p, kHullBottom_m, kHullTop_m, description_);
  description_.footprint_B = outline_B(p);
  description_.max_speed_mps = p.wheel_speed_limit_radps * p.wheel_radius_m;
  description_.min_turning_radius_m = p.min_turning_radius_m();
}

std::vector<VehicleLink> FourWheelSteeringRover::make_links() const {
  std::vector<VehicleLink> links;
  Material material;
  material.name = "four_wheel_steering_rover";
  material.colour = {1.0f, 1.0f, 1.0f};  // the meshes carry their colours
  material.roughness = 0.55f;
  links.push_back(
      {"body", std::make_shared<TriangleMesh>(make_four_wheel_steering_body(params_)), material});
  WheelMeshParams wheel;
  wheel.radius_m = params_.wheel_radius_m;
  wheel.width_m = params_.tyre_width_m;
  wheel.rim_radius_m = 0.58 * params_.wheel_radius_m;
  wheel.lug_height_m = 0.08 * params_.wheel_radius_m;
  wheel.rim_srgb = 0x2b2d30;
  wheel.hub_srgb = 0xb4b8bc;
  Material rubber = material;
  rubber.roughness = 0.9f;
  append_wheel_links(wheel, rubber, links);
  for (const Corner& corner : kCorners) {
    links.push_back({fmt::format("knuckle_{}", corner.name),
                     std::make_shared<TriangleMesh>(make_steering_knuckle(params_, corner)),
                     material});
  }
  return links;
}

std::unique_ptr<Vehicle> make_four_wheel_steering_rover(const ParameterSet& parameters,
                                                        const VehicleContext& context) {
  auto rover = std::make_unique<FourWheelSteeringRover>(
      read_four_wheel_steering_rover_params(parameters, context.vehicle), context.gravity_mps2,
      LinkShelf(parameters, context));
  rover->feel_wind(context.random("wind"));
  return rover;
}

}  // namespace vinerow::vehicles
