#include "controllers/waypoint_guidance/waypoint_guidance_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

double read_or(const ParameterSet& parameters, const char* name, double otherwise) {
  return parameters.has(name) ? parameters.number(name) : otherwise;
}

void read_turns(const ParameterSet& parameters, const ControllerContext& context,
                const std::string& who, WaypointGuidanceParams& params) {
  const VehicleDescription& vehicle = *context.vehicle_description;
  TurnLimits& turn = params.legs.turn;
  const double most_rad =
      vehicle.need_positive(vehicle.need_fixed_wing(who).max_bank_rad, "max_bank_rad", who);
  turn.gravity_mps2 = context.gravity_mps2;
  turn.gain_per_s = parameters.number("turn_gain_per_s");
  turn.bank_rad = parameters.has("bank_deg") ? rad_from_deg(parameters.number("bank_deg"))
                                             : std::min(rad_from_deg(35.0), most_rad);
  turn.bank_rate_radps = rad_from_deg(parameters.number("bank_rate_degps"));
  turn.bank_lag_s = parameters.number("bank_lag_s");
  turn.yaw_lag_s = parameters.number("yaw_lag_s");
  if (turn.bank_rad > most_rad + 1e-9) {
    throw ConfigError(fmt::format(
        "{}: bank_deg = {:.1f} deg is more than the {:.1f} deg that vehicle type '{}' can fly", who,
        deg_from_rad(turn.bank_rad), deg_from_rad(most_rad), vehicle.type));
  }
  // A level turn carries 1 / cos(bank) of the weight.
  const double least_mps = params.stall_mps / std::sqrt(std::cos(turn.bank_rad));
  params.legs.least_airspeed_mps = least_mps;
  params.legs.most_airspeed_mps = vehicle.max_speed_mps.value_or(1e9);
  const double airspeed_mps = read_or(parameters, "airspeed_mps", params.cruise_mps);
  if (airspeed_mps <= least_mps) {
    throw ConfigError(
        fmt::format("{}: airspeed_mps = {:.2f} m/s is not above the {:.2f} m/s at which vehicle "
                    "type '{}' stalls in a level turn at {:.1f} deg of bank",
                    who, airspeed_mps, least_mps, vehicle.type, deg_from_rad(turn.bank_rad)));
  }
  if (airspeed_mps > params.legs.most_airspeed_mps) {
    throw ConfigError(fmt::format(
        "{}: airspeed_mps = {:.2f} m/s is more than the {:.2f} m/s that vehicle type '{}' can fly",
        who, airspeed_mps, params.legs.most_airspeed_mps, vehicle.type));
  }
  params.legs.airspeed_mps = airspeed_mps;
  const double radius_m = turn.radius_m(airspeed_mps);
  params.loiter_radius_m = read_or(parameters, "loiter_radius_m", 1.5 * radius_m);
  if (params.loiter_radius_m < radius_m) {
    throw ConfigError(fmt::format(
        "{}: loiter_radius_m = {:.1f} m is less than the {:.1f} m of a turn at {:.1f} m/s and "
        "{:.1f} deg of bank",
        who, params.loiter_radius_m, radius_m, airspeed_mps, deg_from_rad(turn.bank_rad)));
  }
}

void read_landing(const ParameterSet& parameters, const VehicleDescription& vehicle,
                  const std::string& who, WaypointGuidanceParams& params) {
  if (params.end != WaypointGuidanceParams::End::kLand) {
    for (const char* name :
         {"land_at_m", "land_height_m", "land_course_deg", "approach_speed_mps"}) {
      if (!parameters.has(name)) continue;
      throw ConfigError(fmt::format("{}: {} says how to land, but end is '{}'", who, name,
                                    parameters.text("end")));
    }
  }
  if (parameters.has("land_at_m")) {
    const std::vector<double>& place = parameters.numbers("land_at_m");
    params.land_at_m = Eigen::Vector2d(place[0], place[1]);
  }
  if (parameters.has("land_height_m")) params.land_height_m = parameters.number("land_height_m");
  if (parameters.has("land_course_deg")) {
    params.land_course_rad = rad_from_deg(parameters.number("land_course_deg"));
  }
  const FixedWingAircraft& aircraft = vehicle.need_fixed_wing(who);
  params.standing_m = aircraft.start_height_m.value_or(vehicle.height_above_ground_m);
  params.belly_m = aircraft.belly_height_m;
  params.glide_rad = rad_from_deg(parameters.number("glide_deg"));
  params.flare_m = parameters.number("flare_height_m");
  params.power_off_m = parameters.number("power_off_height_m");
  params.approach_height_m = parameters.number("approach_height_m");
  params.approach_mps = read_or(parameters, "approach_speed_mps", params.legs.airspeed_mps);
  if (params.approach_mps <= params.stall_mps) {
    throw ConfigError(fmt::format(
        "{}: approach_speed_mps = {:.2f} m/s is not above the {:.2f} m/s at which vehicle type "
        "'{}' stalls",
        who, params.approach_mps, params.stall_mps, vehicle.type));
  }
  if (params.flare_m >= params.approach_height_m) {
    throw ConfigError(
        fmt::format("{}: flare_height_m = {:.2f} m is not below approach_height_m = {:.2f} m", who,
                    params.flare_m, params.approach_height_m));
  }
}

}  // namespace

std::vector<ParameterSpec> waypoint_guidance_parameters() {
  const auto angle = [](const char* name, double value, double most, const char* description) {
    ParameterSpec spec = number_parameter(name, "deg", value, 0.0, most, description);
    spec.min_exclusive = true;
    return spec;
  };
  return {
      choice_parameter("law", "smooth", {"smooth", "paper"},
                       "on a leg: smooth: course chi - atan(e / cross_track_length_m); paper: "
                       "bearing to the next waypoint where |e| is beyond the tolerance (eq. 1-5)"),
      choice_parameter(
          "turn_start", "predicted", {"predicted", "formula"},
          "when a turn begins: where flying it ahead in the mean wind leads onto the "
          "next leg, or R tan(|dchi|/2) + V (phi/(2 rate) + lags) before the waypoint"),
      positive_parameter("cross_track_length_m", "m", 15.0, "of law smooth"),
      positive_parameter("tolerance_most_m", "m", 4.0, "law paper: tolerance at a leg's start"),
      positive_parameter("tolerance_least_m", "m", 1.0, "law paper: least tolerance"),
      optional(positive_parameter("airspeed_mps", "m/s", 12.0,
                                  "where the plan tells none; default the vehicle's cruise speed")),
      positive_parameter(
          "airspeed_rate_mps2", "m/s2", 0.5,
          "with which the airspeed changes where the plan or the landing wants another"),
      optional(angle("bank_deg", 35.0, 80.0,
                     "most, in turns; default 35 deg or what the vehicle can, if that is less")),
      positive_parameter("bank_rate_degps", "deg/s", 60.0, "most"),
      positive_parameter("bank_lag_s", "s", 0.3, "of the vehicle's bank behind what it is told"),
      number_parameter("yaw_lag_s", "s", 0.3, 0.0, 5.0,
                       "of the vehicle's turn behind its bank: it slips first"),
      positive_parameter("turn_gain_per_s", "1/s", 1.0,
                         "heading rate wanted per heading difference"),
      number_parameter("kink_m", "m", 15.0, 0.0, 1e3,
                       "length before and after a waypoint over which the height's slope changes"),
      text_parameter("air_data", "", "name of the sensor that tells the wind; '' = none is known"),
      positive_parameter("wind_s", "s", 10.0, "time constant of the mean wind"),
      number_parameter("start_s", "s", 1.0, 0.0, 1e4, "earliest launch after the run's start"),
      angle("launch_climb_deg", 10.0, 45.0, "climb angle straight ahead from the launcher"),
      positive_parameter("launch_height_m", "m", 20.0, "above the start, where the launch ends"),
      angle("climb_max_deg", 10.0, 45.0, "most upwards; where the way is too short it circles"),
      angle("descent_max_deg", 10.0, 45.0, "most downwards"),
      positive_parameter("join_m", "m", 60.0,
                         "a vehicle that is in the air already starts on the plan's first leg "
                         "where that is nearer than this, else flies to its first waypoint"),
      optional(positive_parameter("loiter_radius_m", "m", 31.0,
                                  "of circles; default 1.5 times that of a turn")),
      choice_parameter("loiter_side", "left", {"left", "right"}, "where circles turn to"),
      positive_parameter("loiter_s", "s", 60.0, "how long it circles with end: loiter"),
      choice_parameter("end", "land", {"land", "loiter", "stop"},
                       "after the last waypoint: land; circle about it for loiter_s and end the "
                       "mission in the air; end the mission at once. What has ended in the air "
                       "circles on while others work"),
      optional(number_list_parameter("land_at_m", "m", {},
                                     "[x, y] in W of the touchdown; default the start", 2)),
      optional(number_parameter("land_height_m", "m", 0.0, -1e4, 1e4,
                                "z of W of the ground there; default the ground at the start")),
      optional(number_parameter("land_course_deg", "deg", 0.0, -360.0, 360.0,
                                "course of the landing; default against the mean wind, below 1 m/s "
                                "of wind the heading at the start")),
      positive_parameter("approach_height_m", "m", 30.0,
                         "above the ground, where the glide begins; down to it the vehicle "
                         "circles beside the approach"),
      optional(positive_parameter("approach_speed_mps", "m/s", 10.0,
                                  "airspeed of the glide; default airspeed_mps, where the "
                                  "controllers' trims are")),
      angle("glide_deg", 5.0, 30.0, "of the glide over ground"),
      positive_parameter("flare_height_m", "m", 1.0,
                         "above the touchdown, where the sink rate begins to fade"),
      number_parameter("power_off_height_m", "m", 0.1, 0.0, 1e3,
                       "above the touchdown, where the propeller stops"),
  };
}

WaypointGuidanceParams read_waypoint_guidance_params(const ParameterSet& parameters,
                                                     const ControllerContext& context) {
  const std::string who = context.part + " (waypoint_guidance)";
  const VehicleDescription& vehicle = *context.vehicle_description;
  const FixedWingAircraft& aircraft = vehicle.need_fixed_wing(who);
  WaypointGuidanceParams params;
  params.cruise_mps = vehicle.need_positive(aircraft.cruise_speed_mps, "cruise_speed_mps", who);
  params.stall_mps = vehicle.need_positive(aircraft.stall_speed_mps, "stall_speed_mps", who);
  read_turns(parameters, context, who, params);
  params.legs.climb_max_rad = rad_from_deg(parameters.number("climb_max_deg"));
  params.legs.descent_max_rad = rad_from_deg(parameters.number("descent_max_deg"));
  params.pilot.is_smooth = parameters.text("law") == "smooth";
  params.pilot.is_predicted = parameters.text("turn_start") == "predicted";
  params.pilot.cross_track_length_m = parameters.number("cross_track_length_m");
  params.pilot.tolerance_most_m = parameters.number("tolerance_most_m");
  params.pilot.tolerance_least_m = parameters.number("tolerance_least_m");
  params.kink_m = parameters.number("kink_m");
  params.air_data = parameters.text("air_data");
  params.wind_s = parameters.number("wind_s");
  params.start_s = parameters.number("start_s");
  params.launch_climb_rad = rad_from_deg(parameters.number("launch_climb_deg"));
  params.launch_height_m = parameters.number("launch_height_m");
  params.join_m = parameters.number("join_m");
  params.airspeed_rate_mps2 = parameters.number("airspeed_rate_mps2");
  params.loiter_side = parameters.text("loiter_side") == "left" ? 1.0 : -1.0;
  params.loiter_s = parameters.number("loiter_s");
  const std::string& end = parameters.text("end");
  params.end = end == "land"     ? WaypointGuidanceParams::End::kLand
               : end == "loiter" ? WaypointGuidanceParams::End::kLoiter
                                 : WaypointGuidanceParams::End::kStop;
  read_landing(parameters, vehicle, who, params);
  return params;
}

}  // namespace vinerow
