#include "vehicles/diff_drive_rover/diff_drive_rover_params.h"

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {
namespace {

constexpr ParameterConversion kKmh = {[](double speed_kmh) { return speed_kmh / 3.6; },
                                      [](double speed_mps) { return speed_mps * 3.6; }};

const ParameterTable<DiffDriveRoverParams>& diff_drive_rover_table() {
  using P = DiffDriveRoverParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("fidelity", &P::kinematic, {{"physics", false}, {"kinematic", true}},
                  "forces and slip, or the paper's pure kinematic model")
          .number("max_speed_kmh", "km/h", &P::max_speed_mps, kPositive,
                  "reference speed for controllers", kKmh)
          .number("min_turning_radius_m", "m", &P::min_turning_radius_m, between(0.0, 1e3),
                  "smallest turning radius for planners and controllers")
          .include(chassis_of, chassis_table());
  return table;
}

}  // namespace

void DiffDriveRoverParams::validate() const {
  diff_drive_rover_table().validate(*this, name);
}

PartSpec diff_drive_rover_spec() {
  PartSpec spec;
  spec.name = "diff_drive_rover";
  spec.description =
      "Four-wheel skid-steered rover of paper B (table 1), with wheel and tyre forces or, with "
      "fidelity: kinematic, the paper's pure rolling model (eq. 1-2)";
  spec.writes = {"wheels", "battery", "vehicle_event"};
  diff_drive_rover_table().add_to(spec);
  return spec;
}

DiffDriveRoverParams read_diff_drive_rover_params(const ParameterSet& parameters,
                                                  const std::string& name) {
  DiffDriveRoverParams p = diff_drive_rover_table().read(parameters, name);
  p.name = name;
  return p;
}

}  // namespace vinerow::vehicles
