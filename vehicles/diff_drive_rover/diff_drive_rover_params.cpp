#include "vehicles/diff_drive_rover/diff_drive_rover_params.h"

#include "vehicles/parts/validation.h"
#include "vehicles/parts/wheel_parameters.h"

namespace vinerow::vehicles {

void DiffDriveRoverParams::validate() const {
  demand_positive(name, "wheel_base_m", wheel_base_m);
  demand_positive(name, "track_m", track_m);
  demand_positive(name, "wheel_radius_m", wheel_radius_m);
  demand_positive(name, "tyre_width_m", tyre_width_m);
  demand_positive(name, "max_speed_mps", max_speed_mps);
  demand_not_negative(name, "min_turning_radius_m", min_turning_radius_m);
  demand_positive(name, "wheel_speed_limit_radps", wheel_speed_limit_radps);
  demand_positive(name, "mass_kg", mass_kg);
  demand_positive(name, "com_height_m", com_height_m);
  for (int i = 0; i < 3; ++i) demand_positive(name, "inertia_kgm2", inertia_kgm2[i]);
}

PartSpec diff_drive_rover_spec() {
  const DiffDriveRoverParams d;
  PartSpec spec;
  spec.name = "diff_drive_rover";
  spec.description =
      "Four-wheel skid-steered rover of paper B (table 1), on the shared wheel or, with fidelity: "
      "kinematic, as the paper's pure rolling model (eq. 1-2)";
  spec.writes = {"wheels", "battery"};
  spec.parameters = {
      choice_parameter("fidelity", "physics", {"physics", "kinematic"},
                       "forces and slip, or the paper's pure kinematic model"),
      positive_parameter("wheel_base_m", "m", d.wheel_base_m, "front to rear axle"),
      positive_parameter("track_m", "m", d.track_m, "left to right wheel centre"),
      positive_parameter("wheel_radius_m", "m", d.wheel_radius_m, "rolling radius"),
      positive_parameter("tyre_width_m", "m", d.tyre_width_m, "for the picture and the hull"),
      positive_parameter("max_speed_kmh", "km/h", 7.0, "reference speed told to controllers"),
      number_parameter("min_turning_radius_m", "m", d.min_turning_radius_m, 0.0, 1e3,
                       "smallest turning radius told to planners and controllers"),
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
    spec.parameters.push_back(std::move(drive));
  }
  return spec;
}

DiffDriveRoverParams read_diff_drive_rover_params(const ParameterSet& parameters,
                                                  const std::string& name) {
  DiffDriveRoverParams p;
  p.name = name;
  p.kinematic = parameters.text("fidelity") == "kinematic";
  p.wheel_base_m = parameters.number("wheel_base_m");
  p.track_m = parameters.number("track_m");
  p.wheel_radius_m = parameters.number("wheel_radius_m");
  p.tyre_width_m = parameters.number("tyre_width_m");
  p.max_speed_mps = parameters.number("max_speed_kmh") / 3.6;
  p.min_turning_radius_m = parameters.number("min_turning_radius_m");
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
  p.validate();
  return p;
}

}  // namespace vinerow::vehicles
