#include "controllers/trajectory/trajectory_params.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"

namespace vinerow::controllers {

namespace {

std::string find_fault_in_hover(const TrajectoryParams& p) {
  if (p.hover_m || (!p.hover_yaw_rad && !(p.hover_s > 0.0))) return "";
  return "hover_yaw_deg and hover_s describe how to hold a place: add hover_m";
}

}  // namespace

const ParameterTable<TrajectoryParams>& trajectory_table() {
  using P = TrajectoryParams;
  const auto flight = [](auto member) { return inside(&P::flight, member); };
  const auto limits = [](auto member) {
    return inside(&P::flight, &FlightOptions::limits, member);
  };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("horizon", &P::horizon, between(1, 1000),
                   "points of the reference after the present one: N of the controller")
          .number("sample_s", "s", &P::sample_s, between(1e-3, 10.0),
                  "time between two points of the reference")
          .number("row_speed_mps", "m/s", limits(&TrajectoryLimits::row_speed_mps),
                  between(0.01, 1e3), "speed in rows (paper A, 4.2) and the largest in turns")
          .number("transit_speed_mps", "m/s", limits(&TrajectoryLimits::transit_speed_mps),
                  between(0.01, 1e3), "speed to the first row")
          .number("return_speed_mps", "m/s", limits(&TrajectoryLimits::return_speed_mps),
                  between(0.01, 1e3), "speed of the return")
          .number("climb_speed_mps", "m/s", limits(&TrajectoryLimits::climb_speed_mps),
                  between(0.01, 1e3), "largest upwards, also along slopes")
          .number("descent_speed_mps", "m/s", limits(&TrajectoryLimits::descent_speed_mps),
                  between(0.01, 1e3), "largest downwards, also along slopes")
          .number("landing_speed_mps", "m/s", limits(&TrajectoryLimits::landing_speed_mps),
                  between(0.01, 1e3), "speed of the last landing_zone_m")
          .number("landing_zone_m", "m", limits(&TrajectoryLimits::landing_zone_m),
                  between(0.0, 100.0),
                  "height above the plan's end that is flown at landing_speed_mps")
          .number("landing_reserve_m", "m", flight(&FlightOptions::landing_reserve_m),
                  between(0.0, 100.0),
                  "a landing continues this far below the plan's end until the vehicle is on the "
                  "ground; a touchdown is detected up to this far above it")
          .number("acceleration_mps2", "m/s2", limits(&TrajectoryLimits::acceleration_mps2),
                  between(1e-3, 1e4), "acceleration and deceleration along the path")
          .number("lateral_acceleration_mps2", "m/s2",
                  limits(&TrajectoryLimits::lateral_acceleration_mps2), between(1e-3, 1e4),
                  "maximum acceleration across the path; the default allows 1.63 m/s in a turn of "
                  "1.77 m radius")
          .number("yaw_rate_radps", "rad/s", limits(&TrajectoryLimits::yaw_rate_radps),
                  between(1e-3, 1e4), "maximum yaw rate")
          .number("yaw_acceleration_radps2", "rad/s2",
                  limits(&TrajectoryLimits::yaw_acceleration_radps2), between(1e-3, 1e4),
                  "largest; times the inertia it is the torque of a turn")
          .number("ease_s", "s", limits(&TrajectoryLimits::ease_s), between(0.02, 5.0),
                  "time over which the acceleration along the path builds up")
          .number("blend_m", "m", limits(&TrajectoryLimits::blend_m), between(0.0, 5.0),
                  "length over which curvature builds up; corners are rounded over it")
          .degrees("sharp_deg", flight(&FlightOptions::sharp_rad), between(0.0, 180.0),
                   "at sharper bends of the plan the vehicle stops and turns on the spot")
          .number("wait_m", "m", &P::wait_m, between(0.05, 1e4),
                  "distance between vehicle and reference from which the reference slows down; at "
                  "twice this it waits")
          .number("spin_up_s", "s", flight(&FlightOptions::spin_up_s), between(0.0, 60.0),
                  "rest with turning rotors before the take-off")
          .number("height_m", "m", &P::height_m, between(0.01, 1e4),
                  "height of the centre of mass above plans on the ground, such as those of "
                  "waypoints, coverage, rrt_star")
          .numbers("hover_m", "m", &P::hover_m, between(-1e5, 1e5),
                   "[x, y, height above the ground at the take-off]: fly there and hold the "
                   "place, without a planner")
          .degrees("hover_yaw_deg", &P::hover_yaw_rad, between(-360.0, 360.0),
                   "heading while holding the place; default the heading before the take-off")
          .number("hover_s", "s", &P::hover_s, between(0.0, 1e6),
                  "duration of the hold before the landing; 0 = to the end of the run")
          .rule(find_fault_in_hover);
  return table;
}

TrajectoryParams read_trajectory_params(const ParameterSet& parameters,
                                        const ControllerContext& context) {
  const std::string who = context.part + " (trajectory)";
  const VehicleDescription& vehicle = *context.vehicle_description;
  const Rotorcraft& craft = vehicle.need_rotorcraft(who);
  TrajectoryParams params = trajectory_table().read(parameters, who);
  const TrajectoryLimits& limits = params.flight.limits;
  params.landing.landing_speed_mps = limits.landing_speed_mps;
  params.landing.zone_m = params.flight.landing_reserve_m;
  params.rest_height_m = vehicle.height_above_ground_m;

  const double min_m = params.rest_height_m;
  if (params.height_m <= min_m) {
    throw ConfigError(
        fmt::format("{}: height_m = {:.2f} m is not above the {:.2f} m at which the "
                    "centre of mass of vehicle type '{}' is on the ground",
                    who, params.height_m, min_m, vehicle.type));
  }
  if (limits.landing_speed_mps >= craft.landing_speed_limit_mps) {
    throw ConfigError(
        fmt::format("{}: landing_speed_mps = {:.2f} m/s, must be less than the {:.2f} m/s at which "
                    "touching the ground is a crash for vehicle type '{}'",
                    who, limits.landing_speed_mps, craft.landing_speed_limit_mps, vehicle.type));
  }
  if (vehicle.max_speed_mps) {
    const std::pair<const char*, double> speeds[] = {
        {"row_speed_mps", limits.row_speed_mps},
        {"transit_speed_mps", limits.transit_speed_mps},
        {"return_speed_mps", limits.return_speed_mps}};
    for (const auto& [name, speed_mps] : speeds) {
      if (speed_mps <= *vehicle.max_speed_mps) continue;
      throw ConfigError(
          fmt::format("{}: {} = {:.2f} m/s is more than the {:.2f} m/s that vehicle "
                      "type '{}' can fly",
                      who, name, speed_mps, *vehicle.max_speed_mps, vehicle.type));
    }
  }
  if (!params.hover_m) return params;
  if (params.hover_m->z() <= min_m) {
    throw ConfigError(
        fmt::format("{}: hover_m holds a height of {:.2f} m, which is not above the "
                    "{:.2f} m at which the centre of mass of vehicle type '{}' "
                    "is on the ground",
                    who, params.hover_m->z(), min_m, vehicle.type));
  }
  FlightHold hold;
  hold.duration_s = params.hover_s > 0.0 ? params.hover_s : std::numeric_limits<double>::infinity();
  hold.yaw_rad = params.hover_yaw_rad;
  params.flight.hold = hold;
  return params;
}

}  // namespace vinerow::controllers
