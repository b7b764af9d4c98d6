#include "vehicles/urdf_rover/urdf_rover.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/file_shelf.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "vehicles/parts/effective_track.h"

namespace vinerow::vehicles {
namespace {

std::string find_fault_in_packages(const UrdfRoverParams& p) {
  for (const std::string& entry : p.packages) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) {
      return fmt::format("packages: '{}' must be written as 'name=folder'", entry);
    }
  }
  return "";
}

std::string find_fault_in_joints(const UrdfRoverParams& p) {
  if (p.options.left_joints.empty() == p.options.right_joints.empty()) return "";
  return "left_wheel_joints and right_wheel_joints must be given together or not at all";
}

const ParameterTable<UrdfRoverParams>& urdf_rover_table() {
  using P = UrdfRoverParams;
  using Options = UrdfRoverOptions;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .path("urdf", &P::urdf, "the robot's URDF file")
          .required()
          .texts("packages", &P::packages,
                 "folders of package:// names, each as 'name=folder', relative to the URDF file")
          .texts("left_wheel_joints", inside(&P::options, &Options::left_joints),
                 "joints of the left wheels; without both lists: every continuous joint whose "
                 "axis points across")
          .texts("right_wheel_joints", inside(&P::options, &Options::right_joints),
                 "joints of the right wheels")
          .number("wheel_radius_m", "m", inside(&P::options, &Options::wheel_radius_m), kPositive,
                  "instead of the radius of the wheel's collision shape or mesh")
          .number("max_speed_mps", "m/s", &P::max_speed_mps, kPositive, "told to controllers")
          .number("min_turning_radius_m", "m", &P::min_turning_radius_m, between(0.0, 1e3),
                  "told to planners and controllers")
          .number("wheel_speed_limit_radps", "rad/s", &P::wheel_speed_limit_radps, kPositive,
                  "largest wheel speed command, both ways")
          .number("static_deflection_m", "m", &P::static_deflection_m, kPositive,
                  "of tyres and suspension under the robot's weight")
          .number("damping_ratio", "", &P::damping_ratio, between(0.0, 5.0),
                  "of heave on the wheels")
          .integer("wheel_probes", &P::wheel_probes, between(1, 3),
                   "ground rays per wheel and step on smooth ground: 1 or 3")
          .include(&P::motor, motor_table())
          .include(&P::tyre, tyre_table())
          .include(&P::battery, battery_table(), {.only = {"battery_capacity_Wh", "electronics_W"}})
          .include(&P::air, air_drag_table())
          .rule(find_fault_in_packages)
          .rule(find_fault_in_joints);
  return table;
}

/// The robot of a URDF file, meshes included.
UrdfRoverModel read_model(const UrdfRoverParams& params, FileShelf* shelf) {
  const std::map<std::string, std::filesystem::path> packages = params.package_folders();
  std::string key = file_mark(params.urdf);
  for (const auto& [name, folder] : packages) {
    key += fmt::format("{}={}\n", name, folder.string());
  }
  const auto urdf =
      keep<io::UrdfModel>(shelf, key, [&] { return io::load_urdf(params.urdf, packages); });
  for (const io::UrdfLink& link : urdf->links) {
    for (const auto* shapes : {&link.visuals, &link.collisions}) {
      for (const io::UrdfShape& shape : *shapes) {
        if (shape.kind == io::UrdfShapeKind::kMesh) key += file_mark(shape.mesh_file);
      }
    }
  }
  key += fmt::format("{} {} {}", fmt::join(params.options.left_joints, ","),
                     fmt::join(params.options.right_joints, ","),
                     params.options.wheel_radius_m.value_or(0.0));
  return *keep<UrdfRoverModel>(shelf, key,
                               [&] { return read_urdf_rover(*urdf, params.options); });
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
  urdf_rover_table().validate(*this, name);
}

std::map<std::string, std::filesystem::path> UrdfRoverParams::package_folders() const {
  std::map<std::string, std::filesystem::path> folders;
  for (const std::string& entry : packages) {
    const std::size_t equals = entry.find('=');
    folders[entry.substr(0, equals)] = urdf.parent_path() / entry.substr(equals + 1);
  }
  return folders;
}

PartSpec urdf_rover_spec() {
  PartSpec spec;
  spec.name = "urdf_rover";
  spec.description =
      "Skid-steered robot from a URDF file, on the shared wheel, with the file's own masses";
  spec.writes = {"wheels", "battery"};
  spec.parameters = urdf_rover_table().specs();
  return spec;
}

UrdfRoverParams read_urdf_rover_params(const ParameterSet& parameters, const std::string& name) {
  UrdfRoverParams p = urdf_rover_table().read(parameters, name);
  p.name = name;
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
