#pragma once
/// Parameters of planner `row_flight`.

#include <optional>
#include <string>
#include <vector>

#include "controllers/planning/routes/headland_turn.h"
#include "controllers/planning/routes/route_planner.h"

namespace vinerow::controllers {

struct RowFlightParams {
  RoutePlannerParams route;
  double height_m = 1.5;
  double return_height_m = 3.0;
  std::optional<TurnKind> turns;  ///< closed form of the turns; absent: searched on the grid
  double smooth_m = 2.0;
  double return_smooth_m = 3.0;
  double return_speed_mps = 0.0;
  bool returns = true;
  double rest_height_m = 0.0;  ///< of B above the ground when the vehicle is on it
  double radius_m = 0.5;       ///< of the circle about B that contains the vehicle
};

/// Parameters of row_flight, route_planner.h and the search of rrt_star.
std::vector<ParameterSpec> row_flight_parameters();
/// @throws ConfigError as read_route_planner_params does, and for heights that are not above the
/// vehicle's height on the ground
RowFlightParams read_row_flight_params(const ParameterSet& parameters,
                                       const PlannerContext& context, const std::string& who);

}  // namespace vinerow::controllers
