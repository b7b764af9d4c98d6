#pragma once
/// Parameters of paper B's rover. Sources: assets/vehicles/rover_paper_b.yaml.

#include "engine/api/part.h"
#include "vehicles/parts/chassis.h"

namespace vinerow::vehicles {

/// Paper B's table 1: wheel base 1.5 m, track 1.0 m, wheel radius 0.2 m (ChassisParams' defaults).
struct DiffDriveRoverParams : ChassisParams {
  bool kinematic = false;             ///< the paper's pure rolling instead of forces
  double max_speed_mps = 7.0 / 3.6;   ///< paper B, table 1: reference speed 7 km/h
  double min_turning_radius_m = 1.0;  ///< paper B, table 1

  /// @throws ConfigError
  void validate() const;
};

/// Specification, as `vinerow list` shows it.
PartSpec diff_drive_rover_spec();

/// @param parameters  of diff_drive_rover_spec()
DiffDriveRoverParams read_diff_drive_rover_params(const ParameterSet& parameters,
                                                  const std::string& name);

}  // namespace vinerow::vehicles
