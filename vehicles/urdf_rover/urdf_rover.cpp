#include "vehicles/urdf_rover/urdf_rover.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/file_shelf.h"
#include "engine/core/error.h"
#include "vehicles/parts/validation.h"
#include "vehicles/parts/wheel_parameters.h"

namespace vinerow::vehicles {
namespace {

/// Motors of a 50 kg class robot; sources in assets/vehicles/husky.yaml.
MotorParams default_motor() {
  MotorParams motor;
  motor.max_torque_Nm = 40.0;
  motor.max_power_W = 200.0;
  motor.max_speed_radps = 12.0;
  motor.speed_gain_Nms = 15.0;
  motor.speed_integral_gain_Nm = 80.0;
  motor.brake_torque_Nm = 40.0;
  return motor;
}

/// The robot of a URDF file, meshes included.
UrdfRoverModel read_model(const UrdfRoverParams& params, FileShelf* shelf) {
  std::string key = file_mark(params.urdf);
  for (const auto& [name, folder] : params.packages) {
    key += fmt::format("{}={}\n", name, folder.string());
  }
  const auto urdf = keep<io::UrdfModel>(
      shelf, key, [&] { return io::load_urdf(params.urdf, params.packages); });
  for (const io::UrdfLink& link : urdf->links) {
    for (const auto* shapes : {&link.visuals, &link.collisions}) {
      for (const io::UrdfShape& shape : *shapes) {
        if (shape.kind == io::UrdfShapeKind::kMesh) key += file_mark(shape.mesh_file);
      }
    }
  }
  key += fmt::format("{} {} {}", fmt::join(params.options.left_joints, ","),
                     fmt::join(params.options.right_joints, ","), params.options.wheel_radius_m);
  return *keep<UrdfRoverModel>(shelf, key,
                               [&] { return read_urdf_rover(*urdf, params.options); });
}

BatteryParams default_battery() {
  return {480.0, 20.0};
}

WheeledPlatformParams platform_params(const UrdfRoverParams& p, const UrdfRoverModel& model,
                                      double gravity_mps2) {
  std::vector<Eigen::Vector3d> hubs;
  for (const UrdfWheel& wheel : model.wheels) hubs.push_back(wheel.hub_B);
  const double weight_N = model.mass_kg * gravity_mps2;
  const std::vector<double> loads = calc_static_loads(hubs, weight_N);
  if (loads.empty()) {
    throw ConfigError(
        fmt::format("{}: the centre of mass is not between the wheels: the robot would tip over",
                    p.urdf.string()));
  }
  WheeledPlatformParams platform;
  platform.name = p.name;
  platform.mass_kg = model.mass_kg;
  platform.inertia_B = model.inertia_B;
  platform.shapes = model.shapes;
  platform.battery = p.battery;
  platform.air = p.air;
  platform.com_height_m = model.height_above_ground_m;
  // One spring rate for all wheels; the design loads differ with the centre of mass.
  const auto count = static_cast<double>(loads.size());
  const double stiffness = weight_N / count / p.static_deflection_m;
  const double damping = 2.0 * p.damping_ratio * std::sqrt(stiffness * model.mass_kg / count);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const UrdfWheel& source = model.wheels[i];
    WheelParams wheel;
    wheel.name = source.name;
    wheel.hub_B = source.hub_B;
    wheel.radius_m = source.radius_m;
    wheel.spin_inertia_kgm2 = source.spin_inertia_kgm2;
    wheel.probes = p.wheel_probes;
    wheel.tyre = p.tyre;
    wheel.motor = p.motor;
    wheel.suspension.stiffness_N_per_m = stiffness;
    wheel.suspension.damping_Ns_per_m = damping;
    wheel.suspension.design_load_N = loads[i];
    wheel.suspension.bump_travel_m = 3.0 * p.static_deflection_m;
    wheel.suspension.bump_stiffness_N_per_m = 8.0 * stiffness;
    platform.wheels.push_back(wheel);
  }
  return platform;
}

}  // namespace

void UrdfRoverParams::validate() const {
  demand_positive(name, "max_speed_mps", max_speed_mps);
  demand_not_negative(name, "min_turning_radius_m", min_turning_radius_m);
  demand_positive(name, "wheel_speed_limit_radps", wheel_speed_limit_radps);
  demand_positive(name, "static_deflection_m", static_deflection_m);
  demand_not_negative(name, "damping_ratio", damping_ratio);
}

PartSpec urdf_rover_spec() {
  const UrdfRoverParams d;
  PartSpec spec;
  spec.name = "urdf_rover";
  spec.description =
      "Skid-steered robot from a URDF file, on the shared wheel, with the file's own masses";
  spec.writes = {"wheels", "battery"};
  spec.parameters = {
      required(path_parameter("urdf", "the robot's URDF file")),
      text_list_parameter(
          "packages", {},
          "folders of package:// names, each as 'name=folder', relative to the URDF file"),
      text_list_parameter("left_wheel_joints", {},
                          "joints of the left wheels; without both lists: every continuous joint "
                          "whose axis points across"),
      text_list_parameter("right_wheel_joints", {}, "joints of the right wheels"),
      optional(positive_parameter("wheel_radius_m", "m", 0.2,
                                  "instead of the radius of the wheel's collision shape or mesh")),
      positive_parameter("max_speed_mps", "m/s", d.max_speed_mps, "told to controllers"),
      number_parameter("min_turning_radius_m", "m", d.min_turning_radius_m, 0.0, 1e3,
                       "told to planners and controllers"),
      positive_parameter("wheel_speed_limit_radps", "rad/s", d.wheel_speed_limit_radps,
                         "largest wheel speed command, both ways"),
      positive_parameter("static_deflection_m", "m", d.static_deflection_m,
                         "of tyres and suspension under the robot's weight"),
      number_parameter("damping_ratio", "", d.damping_ratio, 0.0, 5.0, "of heave on the wheels"),
      integer_parameter("wheel_probes", d.wheel_probes, 1, 3,
                        "ground rays per wheel and step on smooth ground: 1 or 3"),
  };
  for (ParameterSpec& drive : drive_parameter_specs(default_motor(), d.tyre, default_battery())) {
    spec.parameters.push_back(std::move(drive));
  }
  for (ParameterSpec& air : air_drag_parameter_specs()) spec.parameters.push_back(std::move(air));
  return spec;
}

UrdfRoverParams read_urdf_rover_params(const ParameterSet& parameters, const std::string& name) {
  UrdfRoverParams p;
  p.name = name;
  p.urdf = parameters.text("urdf");
  for (const std::string& entry : parameters.texts("packages")) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(
          fmt::format("{}: packages: '{}' must be written as 'name=folder'", name, entry));
    }
    p.packages[entry.substr(0, equals)] = p.urdf.parent_path() / entry.substr(equals + 1);
  }
  p.options.left_joints = parameters.texts("left_wheel_joints");
  p.options.right_joints = parameters.texts("right_wheel_joints");
  if (p.options.left_joints.empty() != p.options.right_joints.empty()) {
    throw ConfigError(fmt::format(
        "{}: left_wheel_joints and right_wheel_joints must be given together or not at all", name));
  }
  if (parameters.has("wheel_radius_m"))
    p.options.wheel_radius_m = parameters.number("wheel_radius_m");
  p.max_speed_mps = parameters.number("max_speed_mps");
  p.min_turning_radius_m = parameters.number("min_turning_radius_m");
  p.wheel_speed_limit_radps = parameters.number("wheel_speed_limit_radps");
  p.static_deflection_m = parameters.number("static_deflection_m");
  p.damping_ratio = parameters.number("damping_ratio");
  p.wheel_probes = static_cast<int>(parameters.integer("wheel_probes"));
  p.motor = read_motor_params(parameters);
  p.tyre = read_tyre_params(parameters);
  p.battery = read_battery_params(parameters);
  p.air = read_air_drag_params(parameters);
  p.validate();
  return p;
}

UrdfRover::UrdfRover(const UrdfRoverParams& params, double gravity_mps2, FileShelf* shelf)
    : model_(read_model(params, shelf)) {
  describe(params);
  links_ = model_.links;
  build_platform(platform_params(params, model_, gravity_mps2));
}

void UrdfRover::describe(const UrdfRoverParams& params) {
  description_.type = "urdf_rover";
  for (const UrdfWheel& wheel : model_.wheels) {
    description_.actuators.push_back({fmt::format("wheel_{}_speed_radps", wheel.name), "rad/s",
                                      -params.wheel_speed_limit_radps,
                                      params.wheel_speed_limit_radps});
  }
  description_.mass_kg = model_.mass_kg;
  description_.collision_centre_B = model_.bounds_B.center();
  description_.collision_half_extents_m = 0.5 * model_.bounds_B.sizes();
  description_.height_above_ground_m = model_.height_above_ground_m;
  WheeledVehicle& wheeled = description_.wheeled.emplace();
  wheeled.track_m = model_.track_m;
  wheeled.wheel_base_m = model_.wheel_base_m;
  wheeled.wheel_radius_m = model_.wheels.front().radius_m;
  wheeled.wheel_speed_limit_radps = params.wheel_speed_limit_radps;
  wheeled.effective_track_m = calc_effective_track_m(model_.track_m, model_.wheel_base_m);
  description_.max_speed_mps = params.max_speed_mps;
  description_.min_turning_radius_m = params.min_turning_radius_m;
}

std::unique_ptr<Vehicle> make_urdf_rover(const ParameterSet& parameters,
                                         const VehicleContext& context) {
  auto rover = std::make_unique<UrdfRover>(read_urdf_rover_params(parameters, context.vehicle),
                                           context.gravity_mps2, context.shelf);
  rover->feel_wind(context.random("wind"));
  return rover;
}

}  // namespace vinerow::vehicles
