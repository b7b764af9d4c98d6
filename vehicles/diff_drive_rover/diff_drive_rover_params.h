#pragma once
/// Numbers of paper B's rover. Sources: assets/vehicles/rover_paper_b.yaml.

#include <string>

#include "engine/api/part.h"
#include "vehicles/parts/battery.h"
#include "vehicles/parts/motor.h"
#include "vehicles/parts/tyre.h"

namespace vinerow::vehicles {

struct DiffDriveRoverParams {
  std::string name = "rover";
  bool kinematic = false;                 ///< the paper's pure rolling instead of forces
  double wheel_base_m = 1.5;              ///< paper B, table 1
  double track_m = 1.0;                   ///< paper B, table 1
  double wheel_radius_m = 0.2;            ///< paper B, table 1
  double tyre_width_m = 0.16;             ///< chosen
  double max_speed_mps = 7.0 / 3.6;       ///< paper B, table 1: reference speed 7 km/h
  double min_turning_radius_m = 1.0;      ///< paper B, table 1
  double wheel_speed_limit_radps = 20.0;  ///< of the actuators
  double mass_kg = 180.0;
  double com_height_m = 0.38;                         ///< of B above level ground
  Eigen::Vector3d inertia_kgm2 = {21.0, 56.0, 70.0};  ///< about B's axes
  double wheel_inertia_kgm2 = 0.28;                   ///< about the axle, gear and rotor included
  double suspension_stiffness_N_per_m = 20000.0;
  double suspension_damping_Ns_per_m = 1000.0;
  int wheel_probes = 3;
  MotorParams motor{.max_power_W = 1200.0};
  TyreParams tyre;
  BatteryParams battery;

  /// @throws ConfigError
  void validate() const;
};

/// The spec that `vinerow list` shows.
PartSpec diff_drive_rover_spec();

/// @param parameters  of diff_drive_rover_spec()
DiffDriveRoverParams read_diff_drive_rover_params(const ParameterSet& parameters,
                                                  const std::string& name);

}  // namespace vinerow::vehicles
