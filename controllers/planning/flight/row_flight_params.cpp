#include "controllers/planning/flight/row_flight_params.h"

#include <fmt/format.h>

#include <algorithm>

#include "controllers/planning/routes/rrt_star.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr double kCoarsestPitch_m = 0.5;  // heights are linear between waypoints

double calc_radius_m(const VehicleDescription& vehicle) {
  if (vehicle.rotorcraft && vehicle.rotorcraft->tip_radius_m > 0.0) {
    return vehicle.rotorcraft->tip_radius_m;
  }
  double radius_m = 0.0;
  for (const Eigen::Vector2d& p : vehicle.outline_B()) radius_m = std::max(radius_m, p.norm());
  return radius_m;
}

const ParameterTable<RowFlightParams>& row_flight_table() {
  using P = RowFlightParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("height_m", "m", &P::height_m, above(0.0, 1e4),
                  "height of the vehicle's centre of mass above the map's ground, in rows and "
                  "turns and on the path to the first row")
          .number("return_height_m", "m", &P::return_height_m, above(0.0, 1e4),
                  "minimum height of the centre of mass above ground and canopies on the way home")
          .choice("turns", &P::turns,
                  {{"grid", std::nullopt},
                   {"dubins", TurnKind::kDubins},
                   {"three_point_arc", TurnKind::kThreePointArc}},
                  "grid: searched on the occupancy grid as rrt_star does; dubins and "
                  "three_point_arc: closed forms, for maps without a grid")
          .number("smooth_m", "m", &P::smooth_m, between(0.0, 50.0),
                  "length over which the ground's heights are smoothed")
          .number("return_smooth_m", "m", &P::return_smooth_m, between(0.0, 50.0),
                  "on the way home, the path starts to rise at twice this distance before a canopy")
          .boolean("return_home", &P::returns,
                   "fly home after the last row; false: land at its end")
          .number("return_speed_mps", "m/s", &P::return_speed_mps, between(0.0, 100.0),
                  "wanted speed on the way home; 0 = the guidance's own")
          .include(&P::route, route_planner_table())
          .limit("waypoint_pitch_m", above(0.0, kCoarsestPitch_m));
  return table;
}

}  // namespace

std::vector<ParameterSpec> row_flight_parameters() {
  std::vector<ParameterSpec> specs = row_flight_table().specs();
  for (ParameterSpec& parameter : rrt_star_search_parameters()) {
    specs.push_back(std::move(parameter));
  }
  return specs;
}

RowFlightParams read_row_flight_params(const ParameterSet& parameters,
                                       const PlannerContext& context, const std::string& who) {
  const VehicleDescription& vehicle = *context.vehicle_description;
  RowFlightParams params = row_flight_table().read(parameters, who);
  complete_route_params(context, who, params.route);
  params.rest_height_m = vehicle.height_above_ground_m;
  params.radius_m = calc_radius_m(vehicle);
  if (params.height_m <= params.rest_height_m) {
    throw ConfigError(
        fmt::format("{}: height_m = {:.2f} m is not above {:.2f} m, the height of the centre of "
                    "mass of vehicle type '{}' on the ground",
                    who, params.height_m, params.rest_height_m, vehicle.type));
  }
  if (params.returns && params.return_height_m <= params.height_m) {
    throw ConfigError(
        fmt::format("{}: return_height_m = {:.2f} m is not above height_m = {:.2f} m, so there is "
                    "no climb at the end of the last row",
                    who, params.return_height_m, params.height_m));
  }
  return params;
}

}  // namespace vinerow::controllers
