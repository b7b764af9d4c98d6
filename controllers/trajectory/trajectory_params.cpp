#include "controllers/trajectory/trajectory_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {

std::vector<ParameterSpec> trajectory_parameters() {
  return {
      integer_parameter("horizon", 20, 1, 1000,
                        "points of the reference after the present one: N of the controller"),
      positive_parameter("sample_s", "s", 0.05, "time between two points of the reference"),
      positive_parameter("row_speed_mps", "m/s", 3.0,
                         "speed in rows (paper A, 4.2) and the most in turns"),
      positive_parameter("transit_speed_mps", "m/s", 2.0, "speed on the way to the first row"),
      positive_parameter("return_speed_mps", "m/s", 3.0, "speed on the way home"),
      positive_parameter("climb_speed_mps", "m/s", 1.5, "most upwards, also along slopes"),
      positive_parameter("descent_speed_mps", "m/s", 1.0, "most downwards, also along slopes"),
      positive_parameter("landing_speed_mps", "m/s", 0.3, "speed of the last landing_zone_m"),
      number_parameter("landing_zone_m", "m", 0.5, 0.0, 100.0,
                       "height above the plan's end that is flown at landing_speed_mps"),
      number_parameter("landing_reserve_m", "m", 1.0, 0.0, 100.0,
                       "a landing is continued this far below the plan's end until the vehicle "
                       "stands, and standing counts up to this far above"),
      positive_parameter("acceleration_mps2", "m/s2", 1.0, "along the path, both ways"),
      positive_parameter("lateral_acceleration_mps2", "m/s2", 1.5,
                         "across the path: 1.63 m/s in a turn of 1.77 m radius"),
      positive_parameter("yaw_rate_radps", "rad/s", 1.5, "most"),
      positive_parameter("yaw_acceleration_radps2", "rad/s2", 2.5,
                         "most; times the inertia it is the torque that turning takes"),
      number_parameter("ease_s", "s", 0.5, 0.02, 5.0,
                       "time over which the acceleration along the path sets in"),
      number_parameter("blend_m", "m", 0.8, 0.0, 5.0,
                       "length over which curvature sets in; corners are rounded over it"),
      number_parameter("sharp_deg", "deg", 20.0, 0.0, 180.0,
                       "bends of the plan sharper than this are flown by a stop and a turn on the "
                       "spot"),
      positive_parameter("wait_m", "m", 1.0,
                         "from this distance between vehicle and reference on the reference slows "
                         "down; at twice this it waits"),
      number_parameter("spin_up_s", "s", 1.0, 0.0, 60.0,
                       "rest with turning rotors before the take-off"),
      positive_parameter("height_m", "m", 1.5,
                         "of the centre of mass above plans that lie on the ground, as those of "
                         "waypoints, coverage, rrt_star"),
      optional(number_list_parameter(
          "hover_m", "m", {},
          "[x, y, height above the ground at the take-off]: fly there and hold the place, without "
          "a planner",
          3)),
      optional(number_parameter("hover_yaw_deg", "deg", 0.0, -360.0, 360.0,
                                "heading while holding the place; default the one it came with")),
      number_parameter("hover_s", "s", 0.0, 0.0, 1e6,
                       "how long the place is held before the landing; 0 = to the end of the run"),
  };
}

TrajectoryParams read_trajectory_params(const ParameterSet& parameters,
                                        const ControllerContext& context) {
  const std::string who = context.part + " (trajectory)";
  const VehicleDescription& vehicle = *context.vehicle_description;
  vehicle.need_rotorcraft(who);
  TrajectoryParams params;
  params.horizon = static_cast<int>(parameters.integer("horizon"));
  params.sample_s = parameters.number("sample_s");
  FlightLimits& limits = params.flight.limits;
  limits.row_speed_mps = parameters.number("row_speed_mps");
  limits.transit_speed_mps = parameters.number("transit_speed_mps");
  limits.return_speed_mps = parameters.number("return_speed_mps");
  limits.climb_speed_mps = parameters.number("climb_speed_mps");
  limits.descent_speed_mps = parameters.number("descent_speed_mps");
  limits.landing_speed_mps = parameters.number("landing_speed_mps");
  limits.landing_zone_m = parameters.number("landing_zone_m");
  limits.acceleration_mps2 = parameters.number("acceleration_mps2");
  limits.lateral_acceleration_mps2 = parameters.number("lateral_acceleration_mps2");
  limits.yaw_rate_radps = parameters.number("yaw_rate_radps");
  limits.yaw_acceleration_radps2 = parameters.number("yaw_acceleration_radps2");
  limits.ease_s = parameters.number("ease_s");
  limits.blend_m = parameters.number("blend_m");
  params.flight.sharp_rad = rad_from_deg(parameters.number("sharp_deg"));
  params.flight.spin_up_s = parameters.number("spin_up_s");
  params.flight.landing_reserve_m = parameters.number("landing_reserve_m");
  params.landing.landing_speed_mps = limits.landing_speed_mps;
  params.landing.zone_m = params.flight.landing_reserve_m;
  params.height_m = parameters.number("height_m");
  params.wait_m = parameters.number("wait_m");
  params.standing_m = vehicle.height_above_ground_m;

  const double least_m = params.standing_m;
  if (params.height_m <= least_m) {
    throw ConfigError(
        fmt::format("{}: height_m = {:.2f} m is not above the {:.2f} m at which the "
                    "centre of mass of vehicle type '{}' stands",
                    who, params.height_m, least_m, vehicle.type));
  }
  if (vehicle.max_speed_mps) {
    for (const char* name : {"row_speed_mps", "transit_speed_mps", "return_speed_mps"}) {
      if (parameters.number(name) <= *vehicle.max_speed_mps) continue;
      throw ConfigError(
          fmt::format("{}: {} = {:.2f} m/s is more than the {:.2f} m/s that vehicle "
                      "type '{}' can fly",
                      who, name, parameters.number(name), *vehicle.max_speed_mps, vehicle.type));
    }
  }
  if (!parameters.has("hover_m")) {
    if (parameters.has("hover_yaw_deg") || parameters.number("hover_s") > 0.0) {
      throw ConfigError(who + ": hover_yaw_deg and hover_s say how to hold a place: give hover_m");
    }
    return params;
  }
  const std::vector<double>& place = parameters.numbers("hover_m");
  if (place[2] <= least_m) {
    throw ConfigError(
        fmt::format("{}: hover_m holds a height of {:.2f} m, which is not above the "
                    "{:.2f} m at which the centre of mass of vehicle type '{}' "
                    "stands",
                    who, place[2], least_m, vehicle.type));
  }
  params.hover_m = Eigen::Vector3d(place[0], place[1], place[2]);
  FlightHold hold;
  const double hover_s = parameters.number("hover_s");
  hold.duration_s = hover_s > 0.0 ? hover_s : std::numeric_limits<double>::infinity();
  if (parameters.has("hover_yaw_deg")) {
    hold.yaw_rad = rad_from_deg(parameters.number("hover_yaw_deg"));
  }
  params.flight.hold = hold;
  return params;
}

}  // namespace vinerow
