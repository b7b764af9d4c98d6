#include "controllers/waypoint_guidance/waypoint_guidance_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "controllers/waypoint_guidance/landing_slope.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

/// Parameters as in files; absent optional ones are derived from the vehicle.
struct GivenParams {
  WaypointGuidanceParams params;
  std::optional<double> airspeed_mps;
  std::optional<double> bank_rad;
  std::optional<double> loiter_radius_m;
  std::optional<double> approach_mps;
  std::optional<double> land_bearing_rad;
};

using MissionEnd = WaypointGuidanceParams::End;
constexpr std::array<Choice<MissionEnd>, 3> kEnds = {
    {{"land", MissionEnd::kLand}, {"loiter", MissionEnd::kLoiter}, {"stop", MissionEnd::kStop}}};

std::string find_fault_in_landing(const GivenParams& given) {
  const WaypointGuidanceParams& p = given.params;
  const std::pair<const char*, bool> words[] = {
      {"land_at_m", p.land_at_m.has_value()},
      {"land_height_m", p.land_height_m.has_value()},
      {"land_bearing_deg", given.land_bearing_rad.has_value()},
      {"land_course_deg", p.land_course_rad.has_value()},
      {"approach_speed_mps", given.approach_mps.has_value()}};
  for (const auto& [name, is_given] : words) {
    if (p.end == MissionEnd::kLand || !is_given) continue;
    return fmt::format("{} describes a landing, but end is '{}'", name, name_of(kEnds, p.end));
  }
  if (given.land_bearing_rad && p.land_course_rad) {
    return "land_bearing_deg and land_course_deg, its old form, are both given: leave out the "
           "second";
  }
  if (p.flare_m >= p.approach_height_m) {
    return fmt::format("flare_height_m = {:.2f} m is not below approach_height_m = {:.2f} m",
                       p.flare_m, p.approach_height_m);
  }
  // The ground below the glide is sampled every metre.
  constexpr double kLongest_m = 100e3;
  const double glide_m = LandingSlope(0.0, p.glide_rad, p.flare_m).length_m(p.approach_height_m);
  if (p.end != MissionEnd::kLand || glide_m <= kLongest_m) return "";
  return fmt::format(
      "approach_height_m = {:.6g} m, flare_height_m = {:.6g} m and glide_deg = {:.6g} deg make a "
      "glide of {:.0f} km, must be at most {:.0f} km",
      p.approach_height_m, p.flare_m, deg_from_rad(p.glide_rad), glide_m / 1e3, kLongest_m / 1e3);
}

const ParameterTable<GivenParams>& given_table() {
  using G = GivenParams;
  using P = WaypointGuidanceParams;
  const auto of = [](auto member) { return inside(&G::params, member); };
  const auto legs = [](auto... members) { return inside(&G::params, &P::legs, members...); };
  const auto turn = [](auto member) {
    return inside(&G::params, &P::legs, &FlightLegsOptions::turn, member);
  };
  const auto pilot = [](auto member) { return inside(&G::params, &P::pilot, member); };
  static const ParameterTable<G> table =
      ParameterTable<G>()
          .choice("law", pilot(&LegPilotOptions::is_smooth), {{"smooth", true}, {"paper", false}},
                  "on a leg: smooth: course chi - atan(e / cross_track_length_m); paper: "
                  "bearing to the next waypoint if |e| is beyond the tolerance (eq. 1-5)")
          .choice("turn_start", pilot(&LegPilotOptions::is_predicted),
                  {{"predicted", true}, {"formula", false}},
                  "start of a turn: when simulating it in the mean wind leads onto the next leg, "
                  "or R tan(|dchi|/2) + V (phi/(2 rate) + lags) before the waypoint")
          .number("cross_track_length_m", "m", pilot(&LegPilotOptions::cross_track_length_m),
                  kPositive, "length of law smooth")
          .number("tolerance_max_m", "m", pilot(&LegPilotOptions::tolerance_max_m), kPositive,
                  "law paper: tolerance at a leg's start")
          .formerly("tolerance_most_m")
          .number("tolerance_min_m", "m", pilot(&LegPilotOptions::tolerance_min_m), kPositive,
                  "law paper: smallest tolerance")
          .formerly("tolerance_least_m")
          .number("airspeed_mps", "m/s", &G::airspeed_mps, kPositive,
                  "if the plan has no airspeed; default the vehicle's cruise speed")
          .number("airspeed_rate_mps2", "m/s2", of(&P::airspeed_rate_mps2), kPositive,
                  "rate of changes of the airspeed that the plan or the landing demands")
          .degrees("bank_deg", &G::bank_rad, between(1.0, 80.0),
                   "largest bank in turns; default 35 deg or the vehicle's limit if that is less")
          .number("bank_rate_degps", "deg/s", turn(&TurnLimits::bank_rate_radps), kPositive,
                  "largest rate of the bank", kDegrees)
          .number("bank_lag_s", "s", turn(&TurnLimits::bank_lag_s), kPositive,
                  "lag of the vehicle's bank behind the command")
          .number("yaw_lag_s", "s", turn(&TurnLimits::yaw_lag_s), between(0.0, 5.0),
                  "lag of the vehicle's turn behind its bank: it slips first")
          .number("turn_gain_per_s", "1/s", turn(&TurnLimits::gain_per_s), kPositive,
                  "wanted heading rate per heading difference")
          .number("kink_m", "m", of(&P::kink_m), between(0.0, 1e3),
                  "length before and after a waypoint over which the height's slope changes")
          .text("air_data", of(&P::air_data),
                "name of the sensor that measures the wind; '' = the wind is unknown")
          .number("wind_s", "s", of(&P::wind_s), kPositive, "time constant of the mean wind")
          .number("start_s", "s", of(&P::start_s), between(0.0, 1e4),
                  "earliest launch after the run's start")
          .degrees("launch_climb_deg", of(&P::launch_climb_rad), above(0.0, 45.0),
                   "climb angle straight ahead from the launcher")
          .number("launch_height_m", "m", of(&P::launch_height_m), kPositive,
                  "height above the start at which the launch ends")
          .degrees("climb_max_deg", legs(&FlightLegsOptions::climb_max_rad), above(0.0, 45.0),
                   "largest climb angle; if the path is too short for it the vehicle circles")
          .degrees("descent_max_deg", legs(&FlightLegsOptions::descent_max_rad), above(0.0, 45.0),
                   "largest descent angle")
          .number("join_m", "m", of(&P::join_m), kPositive,
                  "a vehicle that is in the air already starts on the plan's first leg if that is "
                  "nearer than this, else flies to its first waypoint")
          .number("loiter_radius_m", "m", &G::loiter_radius_m, kPositive,
                  "radius of circles; default 1.5 times the turn radius")
          .choice("loiter_side", of(&P::loiter_side), {{"left", 1.0}, {"right", -1.0}},
                  "direction of circles")
          .number("loiter_s", "s", of(&P::loiter_s), kPositive,
                  "duration of the circles with end: loiter")
          .choice("end", of(&P::end), kEnds,
                  "after the last waypoint: land; circle about it for loiter_s and end the "
                  "mission in the air; end the mission at once. A vehicle whose mission has ended "
                  "in the air circles on while others work")
          .numbers("land_at_m", "m", of(&P::land_at_m), kAnyNumber,
                   "[x, y] in W of the touchdown; default the start")
          .number("land_height_m", "m", of(&P::land_height_m), between(-1e4, 1e4),
                  "z in W of the ground there; default from the map, or that of the start if the "
                  "map has no height there")
          .degrees("land_bearing_deg", &G::land_bearing_rad, between(-360.0, 360.0),
                   "course of the landing, clockwise from north; default against the mean wind, "
                   "below 1 m/s of wind the heading at the start, or the nearest course that the "
                   "ground allows")
          .degrees("land_course_deg", of(&P::land_course_rad), between(-360.0, 360.0),
                   "old form of land_bearing_deg, counted from east to the left; warns")
          .number("land_tolerance_m", "m", of(&P::land_tolerance_m), kPositive,
                  "a landing farther than this from the planned touchdown fails the vehicle's task")
          .number("approach_height_m", "m", of(&P::approach_height_m), kPositive,
                  "height above the ground at which the glide starts; the vehicle circles down to "
                  "it beside the approach")
          .number("approach_speed_mps", "m/s", &G::approach_mps, kPositive,
                  "airspeed of the glide; default airspeed_mps, for which the controllers have "
                  "their trims")
          .degrees("glide_deg", of(&P::glide_rad), between(0.5, 30.0),
                   "angle of the glide over ground")
          .number("flare_height_m", "m", of(&P::flare_m), kPositive,
                  "height above the touchdown at which the sink rate starts to decay")
          .number("power_off_height_m", "m", of(&P::power_off_m), between(0.0, 1e3),
                  "height above the touchdown at which the propeller stops")
          .rule(find_fault_in_landing);
  return table;
}

void settle_turns(const GivenParams& given, const ControllerContext& context,
                  const std::string& who, WaypointGuidanceParams& params) {
  const VehicleDescription& vehicle = *context.vehicle_description;
  TurnLimits& turn = params.legs.turn;
  const double max_rad =
      vehicle.need_positive(vehicle.need_fixed_wing(who).max_bank_rad, "max_bank_rad", who);
  turn.gravity_mps2 = context.gravity_mps2;
  turn.bank_rad = given.bank_rad.value_or(std::min(rad_from_deg(35.0), max_rad));
  if (turn.bank_rad > max_rad + 1e-9) {
    throw ConfigError(fmt::format(
        "{}: bank_deg = {:.1f} deg is more than the {:.1f} deg that vehicle type '{}' can fly", who,
        deg_from_rad(turn.bank_rad), deg_from_rad(max_rad), vehicle.type));
  }
  // The lift of a level turn is 1 / cos(bank) of the weight.
  const double min_mps = params.stall_mps / std::sqrt(std::cos(turn.bank_rad));
  params.legs.min_airspeed_mps = min_mps;
  params.legs.max_airspeed_mps = vehicle.max_speed_mps.value_or(1e9);
  const double airspeed_mps = given.airspeed_mps.value_or(params.cruise_mps);
  if (airspeed_mps <= min_mps) {
    throw ConfigError(
        fmt::format("{}: airspeed_mps = {:.2f} m/s is not above the {:.2f} m/s at which vehicle "
                    "type '{}' stalls in a level turn at {:.1f} deg of bank",
                    who, airspeed_mps, min_mps, vehicle.type, deg_from_rad(turn.bank_rad)));
  }
  if (airspeed_mps > params.legs.max_airspeed_mps) {
    throw ConfigError(fmt::format(
        "{}: airspeed_mps = {:.2f} m/s is more than the {:.2f} m/s that vehicle type '{}' can fly",
        who, airspeed_mps, params.legs.max_airspeed_mps, vehicle.type));
  }
  params.legs.airspeed_mps = airspeed_mps;
  const double radius_m = turn.radius_m(airspeed_mps);
  params.loiter_radius_m = given.loiter_radius_m.value_or(1.5 * radius_m);
  if (params.loiter_radius_m < radius_m) {
    throw ConfigError(fmt::format(
        "{}: loiter_radius_m = {:.1f} m is less than the {:.1f} m of a turn at {:.1f} m/s and "
        "{:.1f} deg of bank",
        who, params.loiter_radius_m, radius_m, airspeed_mps, deg_from_rad(turn.bank_rad)));
  }
}

void settle_landing(const GivenParams& given, const VehicleDescription& vehicle,
                    const std::string& who, WaypointGuidanceParams& params) {
  const FixedWingAircraft& aircraft = vehicle.need_fixed_wing(who);
  params.rest_height_m = aircraft.start_height_m.value_or(vehicle.height_above_ground_m);
  params.belly_m = aircraft.belly_height_m;
  if (given.land_bearing_rad) params.land_course_rad = 0.5 * kPi - *given.land_bearing_rad;
  if (given.params.land_course_rad) {
    params.old_key = fmt::format(
        "land_course_deg = {:g} counts from east to the left and is old: write land_bearing_deg: "
        "{:g}, clockwise from north",
        deg_from_rad(*given.params.land_course_rad),
        deg_from_rad(wrap_angle(0.5 * kPi - *given.params.land_course_rad)));
  }
  params.approach_mps = given.approach_mps.value_or(params.legs.airspeed_mps);
  if (params.approach_mps <= params.stall_mps) {
    throw ConfigError(fmt::format(
        "{}: approach_speed_mps = {:.2f} m/s is not above the {:.2f} m/s at which vehicle type "
        "'{}' stalls",
        who, params.approach_mps, params.stall_mps, vehicle.type));
  }
  if (params.approach_mps > params.legs.max_airspeed_mps) {
    throw ConfigError(fmt::format(
        "{}: approach_speed_mps = {:.2f} m/s is more than the {:.2f} m/s that vehicle type '{}' "
        "can fly",
        who, params.approach_mps, params.legs.max_airspeed_mps, vehicle.type));
  }
}

}  // namespace

void add_waypoint_guidance_parameters(PartSpec& spec) {
  given_table().add_to(spec);
}

WaypointGuidanceParams read_waypoint_guidance_params(const ParameterSet& parameters,
                                                     const ControllerContext& context) {
  const std::string who = context.part + " (waypoint_guidance)";
  const VehicleDescription& vehicle = *context.vehicle_description;
  const FixedWingAircraft& aircraft = vehicle.need_fixed_wing(who);
  const GivenParams given = given_table().read(parameters, who);
  WaypointGuidanceParams params = given.params;
  params.cruise_mps = vehicle.need_positive(aircraft.cruise_speed_mps, "cruise_speed_mps", who);
  params.stall_mps = vehicle.need_positive(aircraft.stall_speed_mps, "stall_speed_mps", who);
  settle_turns(given, context, who, params);
  settle_landing(given, vehicle, who, params);
  return params;
}

}  // namespace vinerow::controllers
