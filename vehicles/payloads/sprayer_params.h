#pragma once
/// Parameters of a sprayer: positions and flow of its nozzles, and rules for its sections.

#include <optional>
#include <string>
#include <vector>

#include "engine/api/part.h"
#include "engine/math/angles.h"
#include "vehicles/payloads/spray_jet.h"

namespace vinerow::vehicles {

struct SprayerParams {
  // Nozzles, the same on both sides. Heights are above the ground on level ground.
  std::vector<double> nozzle_heights_m = {0.85, 1.1, 1.4, 1.65};
  std::vector<double> nozzle_elevation_rad = {0.0};  ///< of each nozzle's axis, positive upward
  double boom_x_m = -0.6;                            ///< of all nozzles in B
  double nozzle_offset_m = 0.3;                      ///< to the left and to the right of B's x axis
  double spray_half_angle_rad = rad_from_deg(25.0);  ///< of the outer cone
  double hollow_half_angle_rad = 0.0;  ///< of the inner cone, which is empty; follows from a share
  double nozzle_flow_lps = 0.0;        ///< of one nozzle; follows from the working pressure
  double tank_l = 60.0;
  SprayParams spray;
  std::optional<double> leaf_area_density_m2pm3;  ///< absent: the world's

  // Sections: left and right.
  bool on_legs_only = false;
  double row_reach_m = 2.0;
  double max_angle_rad = rad_from_deg(20.0);
  double beyond_end_m = 0.0;
  double min_speed_mps = 0.2;
  double valve_lag_s = 0.2;
  double lead_s = 0.2;  ///< default: follows from valve_lag_s

  // Simulation and evaluation.
  int rays_per_nozzle = 2;
  double step_m = 0.25;
  double band_m = 0.25;
  double wanted_ml_per_m2 = 3.0;
};

void add_sprayer_parameters(PartSpec& spec);
/// @param who  for errors, "rover.sprayer"
/// @throws ConfigError if values contradict each other
SprayerParams read_sprayer(const ParameterSet& parameters, const std::string& who);

}  // namespace vinerow::vehicles
