#include "controllers/planning/row_flight_params.h"

#include <fmt/format.h>

#include <algorithm>

#include "controllers/planning/rrt_star.h"
#include "engine/core/error.h"

namespace vinerow {
namespace {

constexpr double kCoarsestPitch_m = 0.5;  // heights between waypoints are straight

double calc_radius_m(const VehicleDescription& vehicle) {
  if (vehicle.rotorcraft && vehicle.rotorcraft->tip_radius_m > 0.0) {
    return vehicle.rotorcraft->tip_radius_m;
  }
  double radius_m = 0.0;
  for (const Eigen::Vector2d& p : vehicle.outline_B()) radius_m = std::max(radius_m, p.norm());
  return radius_m;
}

}  // namespace

std::vector<ParameterSpec> row_flight_parameters() {
  std::vector<ParameterSpec> specs = {
      positive_parameter("height_m", "m", 1.5,
                         "of the vehicle's centre of mass above the map's ground, in rows and "
                         "turns and on the way to the first row"),
      positive_parameter("return_height_m", "m", 3.0,
                         "least height of the centre of mass above ground and canopies on the way "
                         "home"),
      choice_parameter("turns", "grid", {"grid", "dubins", "three_point_arc"},
                       "grid: searched on the occupancy grid as rrt_star does; dubins and "
                       "three_point_arc: closed forms, for maps without a grid"),
      number_parameter("smooth_m", "m", 2.0, 0.0, 50.0,
                       "length over which the ground's heights are smoothed"),
      number_parameter("return_smooth_m", "m", 3.0, 0.0, 50.0,
                       "on the way home the path rises this far before a canopy to twice this "
                       "far, from above"),
      boolean_parameter("return_home", true, "fly home after the last row; else land at its end"),
      number_parameter("return_speed_mps", "m/s", 0.0, 0.0, 100.0,
                       "wanted speed on the way home; 0 = the guidance's own"),
  };
  for (ParameterSpec& parameter : route_planner_parameters()) {
    if (parameter.name == "waypoint_pitch_m") parameter.max = kCoarsestPitch_m;
    specs.push_back(std::move(parameter));
  }
  for (ParameterSpec& parameter : rrt_star_search_parameters()) {
    specs.push_back(std::move(parameter));
  }
  return specs;
}

RowFlightParams read_row_flight_params(const ParameterSet& parameters,
                                       const PlannerContext& context, const std::string& who) {
  const VehicleDescription& vehicle = *context.vehicle_description;
  RowFlightParams params;
  params.route = read_route_planner_params(parameters, context, who);
  params.height_m = parameters.number("height_m");
  params.return_height_m = parameters.number("return_height_m");
  params.smooth_m = parameters.number("smooth_m");
  params.return_smooth_m = parameters.number("return_smooth_m");
  params.return_speed_mps = parameters.number("return_speed_mps");
  params.returns = parameters.boolean("return_home");
  params.standing_m = vehicle.height_above_ground_m;
  params.radius_m = calc_radius_m(vehicle);
  if (params.height_m <= params.standing_m) {
    throw ConfigError(
        fmt::format("{}: height_m = {:.2f} m is not above the {:.2f} m at which the centre of mass "
                    "of vehicle type '{}' stands",
                    who, params.height_m, params.standing_m, vehicle.type));
  }
  if (params.returns && params.return_height_m <= params.height_m) {
    throw ConfigError(
        fmt::format("{}: return_height_m = {:.2f} m is not above height_m = {:.2f} m, the climb at "
                    "the end of the last row leads nowhere",
                    who, params.return_height_m, params.height_m));
  }
  return params;
}

}  // namespace vinerow
