#include "vehicles/parts/chassis.h"

#include <fmt/format.h>

#include "vehicles/parts/validation.h"
#include "vehicles/parts/wheel_parameters.h"

namespace vinerow::vehicles {

void ChassisParams::validate_chassis() const {
  demand_positive(name, "wheel_base_m", wheel_base_m);
  demand_positive(name, "track_m", track_m);
  demand_positive(name, "wheel_radius_m", wheel_radius_m);
  demand_positive(name, "tyre_width_m", tyre_width_m);
  demand_positive(name, "wheel_speed_limit_radps", wheel_speed_limit_radps);
  demand_positive(name, "mass_kg", mass_kg);
  demand_positive(name, "com_height_m", com_height_m);
  for (int i = 0; i < 3; ++i) demand_positive(name, "inertia_kgm2", inertia_kgm2[i]);
}

Eigen::Vector3d ChassisParams::hub_B(const Corner& corner) const {
  return {0.5 * corner.along * wheel_base_m, 0.5 * corner.across * track_m,
          wheel_radius_m - com_height_m};
}

std::vector<ParameterSpec> chassis_parameter_specs(const ChassisParams& d) {
  std::vector<ParameterSpec> specs = {
      positive_parameter("wheel_base_m", "m", d.wheel_base_m, "front to rear axle"),
      positive_parameter("track_m", "m", d.track_m, "left to right wheel centre"),
      positive_parameter("wheel_radius_m", "m", d.wheel_radius_m, "rolling radius"),
      positive_parameter("tyre_width_m", "m", d.tyre_width_m, "for the picture and the hull"),
      positive_parameter("wheel_speed_limit_radps", "rad/s", d.wheel_speed_limit_radps,
                         "largest wheel speed command, both ways"),
      positive_parameter("mass_kg", "kg", d.mass_kg, "wheels included"),
      positive_parameter("com_height_m", "m", d.com_height_m, "centre of mass above level ground"),
      number_list_parameter("inertia_kgm2", "kg m2",
                            {d.inertia_kgm2.x(), d.inertia_kgm2.y(), d.inertia_kgm2.z()},
                            "moments about the body's x, y, z axes", 3),
      positive_parameter("wheel_inertia_kgm2", "kg m2", d.wheel_inertia_kgm2,
                         "one wheel with gear and rotor about its axle"),
      positive_parameter("suspension_stiffness_N_per_m", "N/m", d.suspension_stiffness_N_per_m,
                         "spring and tyre of one wheel in series"),
      number_parameter("suspension_damping_Ns_per_m", "N s/m", d.suspension_damping_Ns_per_m, 0.0,
                       1e6, "damper of one wheel"),
      integer_parameter("wheel_probes", d.wheel_probes, 1, 3,
                        "ground rays per wheel and step on smooth ground: 1 or 3"),
  };
  for (ParameterSpec& drive : drive_parameter_specs(d.motor, d.tyre, d.battery)) {
    specs.push_back(std::move(drive));
  }
  for (ParameterSpec& air : air_drag_parameter_specs()) specs.push_back(std::move(air));
  return specs;
}

void read_chassis_params(const ParameterSet& parameters, const std::string& name,
                         ChassisParams& p) {
  p.name = name;
  p.wheel_base_m = parameters.number("wheel_base_m");
  p.track_m = parameters.number("track_m");
  p.wheel_radius_m = parameters.number("wheel_radius_m");
  p.tyre_width_m = parameters.number("tyre_width_m");
  p.wheel_speed_limit_radps = parameters.number("wheel_speed_limit_radps");
  p.mass_kg = parameters.number("mass_kg");
  p.com_height_m = parameters.number("com_height_m");
  const std::vector<double>& inertia = parameters.numbers("inertia_kgm2");
  p.inertia_kgm2 = {inertia[0], inertia[1], inertia[2]};
  p.wheel_inertia_kgm2 = parameters.number("wheel_inertia_kgm2");
  p.suspension_stiffness_N_per_m = parameters.number("suspension_stiffness_N_per_m");
  p.suspension_damping_Ns_per_m = parameters.number("suspension_damping_Ns_per_m");
  p.wheel_probes = static_cast<int>(parameters.integer("wheel_probes"));
  p.motor = read_motor_params(parameters);
  p.tyre = read_tyre_params(parameters);
  p.battery = read_battery_params(parameters);
  p.air = read_air_drag_params(parameters);
}

WheeledPlatformParams chassis_platform_params(const ChassisParams& p, double gravity_mps2) {
  WheeledPlatformParams platform;
  platform.name = p.name;
  platform.mass_kg = p.mass_kg;
  platform.inertia_B = p.inertia_kgm2.asDiagonal();
  platform.battery = p.battery;
  platform.air = p.air;
  platform.com_height_m = p.com_height_m;
  for (const Corner& corner : kCorners) {
    WheelParams wheel;
    wheel.name = corner.name;
    wheel.hub_B = p.hub_B(corner);
    wheel.radius_m = p.wheel_radius_m;
    wheel.spin_inertia_kgm2 = p.wheel_inertia_kgm2;
    wheel.probes = p.wheel_probes;
    wheel.tyre = p.tyre;
    wheel.motor = p.motor;
    wheel.suspension.stiffness_N_per_m = p.suspension_stiffness_N_per_m;
    wheel.suspension.damping_Ns_per_m = p.suspension_damping_Ns_per_m;
    wheel.suspension.design_load_N = 0.25 * p.mass_kg * gravity_mps2;
    platform.wheels.push_back(wheel);
  }
  return platform;
}

void append_wheel_speed_actuators(const ChassisParams& params, std::vector<ActuatorSpec>& out) {
  for (const Corner& corner : kCorners) {
    out.push_back({fmt::format("wheel_{}_speed_radps", corner.name), "rad/s",
                   -params.wheel_speed_limit_radps, params.wheel_speed_limit_radps});
  }
}

void append_wheel_links(WheelMeshParams wheel, const Material& material,
                        std::vector<VehicleLink>& out) {
  wheel.left = true;
  const auto left = std::make_shared<TriangleMesh>(make_wheel_mesh(wheel));
  wheel.left = false;
  const auto right = std::make_shared<TriangleMesh>(make_wheel_mesh(wheel));
  for (const Corner& corner : kCorners) {
    out.push_back(
        {fmt::format("wheel_{}", corner.name), corner.across > 0.0 ? left : right, material});
  }
}

}  // namespace vinerow::vehicles
