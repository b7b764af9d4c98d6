#include "vehicles/diff_drive_rover/diff_drive_rover_params.h"

#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {

void DiffDriveRoverParams::validate() const {
  validate_chassis();
  demand_positive(name, "max_speed_mps", max_speed_mps);
  demand_not_negative(name, "min_turning_radius_m", min_turning_radius_m);
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
      positive_parameter("max_speed_kmh", "km/h", 7.0, "reference speed told to controllers"),
      number_parameter("min_turning_radius_m", "m", d.min_turning_radius_m, 0.0, 1e3,
                       "smallest turning radius told to planners and controllers"),
  };
  for (ParameterSpec& shared : chassis_parameter_specs(d)) {
    spec.parameters.push_back(std::move(shared));
  }
  return spec;
}

DiffDriveRoverParams read_diff_drive_rover_params(const ParameterSet& parameters,
                                                  const std::string& name) {
  DiffDriveRoverParams p;
  read_chassis_params(parameters, name, p);
  p.kinematic = parameters.text("fidelity") == "kinematic";
  p.max_speed_mps = parameters.number("max_speed_kmh") / 3.6;
  p.min_turning_radius_m = parameters.number("min_turning_radius_m");
  p.validate();
  return p;
}

}  // namespace vinerow::vehicles
