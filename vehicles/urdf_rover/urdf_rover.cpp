#include "vehicles/urdf_rover/urdf_rover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/file_shelf.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/math/angles.h"
#include "vehicles/parts/chassis.h"
#include "vehicles/parts/effective_track.h"

namespace vinerow::vehicles {
namespace {

/// Some files limit a joint by what it could turn alone.
constexpr double kMaxJointLimit_rad = rad_from_deg(60.0);

/// Two radii that differ by less are the same but for a mesh's facets.
constexpr double kSameRadius = 0.02;

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
          .texts("steering_joints", inside(&P::options, &Options::steering_joints),
                 "steering joints of the front wheels, or of all four; without the list: joints "
                 "that carry a wheel and turn about the vertical through its hub")
          .degrees("max_steer_deg", &P::max_steer_rad, between(1.0, 60.0),
                   "maximum steering angle to each side; default: the steering joints' limits, at "
                   "most 60")
          .include(&P::servo, steering_servo_table())
          .choice(
              "driven_wheels", &P::driven,
              {{"auto", DrivenWheels::kAuto},
               {"all", DrivenWheels::kAll},
               {"rear", DrivenWheels::kRear}},
              "wheels with a motor; auto: the rear ones if only the front wheels steer, else all")
          .number("wheel_radius_m", "m", inside(&P::options, &Options::wheel_radius_m), kPositive,
                  "instead of the radius of the wheel's collision shape or mesh")
          .number("max_speed_mps", "m/s", &P::max_speed_mps, kPositive,
                  "maximum speed that controllers command")
          .number("min_turning_radius_m", "m", &P::min_turning_radius_m, between(0.0, 1e3),
                  "minimum turning radius that planners and controllers use; with steered axles at "
                  "least that of the axles")
          .number("wheel_speed_limit_radps", "rad/s", &P::wheel_speed_limit_radps, kPositive,
                  "largest wheel speed command in both directions")
          .number("static_deflection_m", "m", &P::static_deflection_m, kPositive,
                  "deflection of tyres and suspension under the robot's weight")
          .number("damping_ratio", "", &P::damping_ratio, between(0.0, 5.0),
                  "damping ratio of heave on the wheels")
          .integer("wheel_probes", &P::wheel_probes, between(1, 3),
                   "ground rays per wheel and step on smooth ground: 1 or 3")
          .include(&P::motor, motor_table())
          .include(&P::tyre, tyre_table())
          .include(&P::battery, battery_table())
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
  key += fmt::format("{} {} {} {}", fmt::join(params.options.left_joints, ","),
                     fmt::join(params.options.right_joints, ","),
                     fmt::join(params.options.steering_joints, ","),
                     params.options.wheel_radius_m.value_or(0.0));
  return *keep<UrdfRoverModel>(shelf, key, [&] { return read_urdf_rover(*urdf, params.options); });
}

/// Places of the wheels that have a motor. @throws ConfigError
std::vector<std::size_t> find_driven(const UrdfRoverParams& p, const UrdfRoverModel& model) {
  const bool is_car = model.steering && model.steering->axles == 1;
  if (p.driven == DrivenWheels::kRear && !is_car) {
    throw ConfigError(fmt::format(
        "{}: driven_wheels = rear is for a robot that steers by its front wheels, this one {}",
        p.urdf.string(), model.steering ? "steers by all four" : "has no steered wheels"));
  }
  const bool rear = p.driven == DrivenWheels::kRear || (p.driven == DrivenWheels::kAuto && is_car);
  std::vector<std::size_t> driven;
  for (std::size_t i = 0; i < model.wheels.size(); ++i) {
    if (!rear || model.wheels[i].name[0] == 'r') driven.push_back(i);
  }
  // Controllers know one radius.
  const UrdfWheel& first = model.wheels[driven.front()];
  for (const std::size_t i : driven) {
    const UrdfWheel& wheel = model.wheels[i];
    if (std::abs(wheel.radius_m - first.radius_m) <= kSameRadius * first.radius_m) continue;
    throw ConfigError(fmt::format(
        "{}: driven wheels '{}' and '{}' have radii of {:.4g} and {:.4g} m, must be alike{}",
        p.urdf.string(), first.joint, wheel.joint, first.radius_m, wheel.radius_m,
        is_car ? "; or set driven_wheels = rear" : ""));
  }
  return driven;
}

WheeledPlatformParams platform_params(const UrdfRoverParams& p, const UrdfRoverModel& model,
                                      const std::vector<std::size_t>& driven, double gravity_mps2) {
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
    if (!std::binary_search(driven.begin(), driven.end(), i)) {
      wheel.motor.max_torque_Nm = 0.0;  // it rolls freely
      wheel.motor.brake_torque_Nm = 0.0;
    }
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
      "Wheeled robot from a URDF file, with wheel and tyre forces and the file's own masses: skid "
      "steering, Ackermann steering, or four steered wheels";
  spec.writes = {"wheels", "battery", "vehicle_event"};
  urdf_rover_table().add_to(spec);
  return spec;
}

UrdfRoverParams read_urdf_rover_params(const ParameterSet& parameters, const std::string& name) {
  UrdfRoverParams p = urdf_rover_table().read(parameters, name);
  p.name = name;
  return p;
}

UrdfRover::UrdfRover(const UrdfRoverParams& params, double gravity_mps2, FileShelf* shelf)
    : model_(read_model(params, shelf)), driven_wheels_(find_driven(params, model_)) {
  describe(params);
  links_ = model_.links;
  note_ = join(model_.notes, "; ");
  build_platform(platform_params(params, model_, driven_wheels_, gravity_mps2), driven_wheels_);
}

void UrdfRover::describe(const UrdfRoverParams& params) {
  description_.type = "urdf_rover";
  if (model_.steering) describe_steering(params);
  WheeledVehicle& wheeled = description_.wheeled.emplace();
  for (const std::size_t i : driven_wheels_) {
    wheeled.wheels.push_back(
        {static_cast<int>(description_.actuators.size()), model_.wheels[i].hub_B.head<2>()});
    description_.actuators.push_back({fmt::format("wheel_{}_speed_radps", model_.wheels[i].name),
                                      "rad/s", -params.wheel_speed_limit_radps,
                                      params.wheel_speed_limit_radps});
  }
  description_.mass_kg = model_.mass_kg;
  description_.battery_capacity_J = params.battery.capacity_Wh * 3600.0;
  description_.collision_centre_B = model_.bounds_B.center();
  description_.collision_half_extents_m = 0.5 * model_.bounds_B.sizes();
  description_.height_above_ground_m = model_.height_above_ground_m;
  wheeled.track_m = model_.track_m;
  wheeled.wheel_base_m = model_.wheel_base_m;
  wheeled.wheel_radius_m = model_.wheels[driven_wheels_.front()].radius_m;
  wheeled.wheel_speed_limit_radps = params.wheel_speed_limit_radps;
  if (!model_.steering) {
    wheeled.effective_track_m = calc_effective_track_m(model_.track_m, model_.wheel_base_m);
    description_.min_turning_radius_m = params.min_turning_radius_m;
  }
  description_.max_speed_mps = params.max_speed_mps;
}

void UrdfRover::describe_steering(const UrdfRoverParams& params) {
  const UrdfSteering& steering = *model_.steering;
  std::optional<double> max_rad = params.max_steer_rad;
  if (!max_rad && steering.max_wheel_steer_rad) {
    max_rad = std::min(*steering.max_wheel_steer_rad, kMaxJointLimit_rad);
  }
  if (!max_rad) {
    throw ConfigError(fmt::format("{}: the steering joints have no limits; give max_steer_deg",
                                  params.urdf.string()));
  }
  // The wheels roll about a centre at k = tan(d) axles / L beside the middle; the inner one, half a
  // track nearer, is turned by tan(d_inner) = tan(d) / (1 - k B / 2).
  const double base_m = model_.wheel_base_m, axles = static_cast<double>(steering.axles);
  const double inner = std::tan(*max_rad);
  const double tangent = inner / (1.0 + inner * axles * 0.5 * model_.track_m / base_m);
  const double radius_m = base_m / (axles * tangent);
  SteeringGear gear;
  gear.axles = {steering.front_m, steering.rear_m, model_.track_m};
  gear.servo = params.servo;
  gear.max_axle_steer_rad = std::atan(tangent);
  gear.steered_axles = steering.axles;
  for (std::size_t corner = 0; corner < kCorners.size(); ++corner) {
    const auto at =
        std::find_if(model_.wheels.begin(), model_.wheels.end(),
                     [&](const UrdfWheel& wheel) { return wheel.name == kCorners[corner].name; });
    gear.wheels[corner] = static_cast<std::size_t>(at - model_.wheels.begin());
  }
  gear.knuckles = model_.knuckles;
  build_steering(std::move(gear));
  // Of B: it stands beside the fixed rear axle, or between two axles that steer alike.
  const double behind_m =
      steering.axles == 1 ? steering.rear_m : 0.5 * (steering.rear_m - steering.front_m);
  description_.min_turning_radius_m =
      std::max(std::hypot(radius_m, behind_m), params.min_turning_radius_m);
}

std::unique_ptr<Vehicle> make_urdf_rover(const ParameterSet& parameters,
                                         const VehicleContext& context) {
  auto rover = std::make_unique<UrdfRover>(read_urdf_rover_params(parameters, context.vehicle),
                                           context.gravity_mps2, context.shelf);
  rover->feel_wind(context.random("wind"));
  return rover;
}

}  // namespace vinerow::vehicles
