#pragma once
/// Parameters of guidance `trajectory`.

#include <optional>

#include "controllers/trajectory/flight_trajectory.h"
#include "controllers/trajectory/landing_watch.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

struct TrajectoryParams {
  int horizon = 20;
  double sample_s = 0.05;
  FlightOptions flight;
  LandingWatch::Params landing;
  double height_m = 1.5;  ///< above plans on the ground
  double wait_m = 1.0;
  double rest_height_m = 0.0;  ///< of B above the ground before take-off
  /// Without a planner: x, y in W and the height above the ground at the take-off.
  std::optional<Eigen::Vector3d> hover_m;
  std::optional<double> hover_yaw_rad;  ///< heading there; absent: the heading at take-off
  double hover_s = 0.0;                 ///< duration; 0: to the end of the run
};

const ParameterTable<TrajectoryParams>& trajectory_table();
/// @throws ConfigError for a vehicle without rotors, one that is slower than the wanted speeds, or
/// hover parameters without hover_m
TrajectoryParams read_trajectory_params(const ParameterSet& parameters,
                                        const ControllerContext& context);

}  // namespace vinerow::controllers
