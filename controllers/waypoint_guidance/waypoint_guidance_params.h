#pragma once
/// Parameters of guidance `waypoint_guidance`.

#include <optional>
#include <string>
#include <vector>

#include "controllers/waypoint_guidance/flight_legs.h"
#include "controllers/waypoint_guidance/leg_pilot.h"
#include "engine/api/stepped_parts.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

struct WaypointGuidanceParams {
  enum class End { kLand, kLoiter, kStop };
  FlightLegsOptions legs;  ///< with the limits of turns and the airspeed
  LegPilotOptions pilot;
  double cruise_mps = 12.0;  ///< of the vehicle
  double stall_mps = 8.0;
  double kink_m = 15.0;
  std::string air_data;  ///< name of the sensor, "" = none
  double wind_s = 10.0;
  double start_s = 1.0;
  double launch_climb_rad = rad_from_deg(10.0);
  double launch_height_m = 20.0;
  double join_m = 60.0;
  double airspeed_rate_mps2 = 0.5;
  double loiter_radius_m = 0.0;  ///< default: 1.5 times the radius of a turn
  double loiter_side = 1.0;      ///< +1 left
  double loiter_s = 60.0;
  End end = End::kLand;
  std::optional<Eigen::Vector2d> land_at_m;
  std::optional<double> land_height_m;
  std::optional<double> land_course_rad;  ///< from east, positive to the left
  double land_tolerance_m = 50.0;
  std::string old_key;         ///< renamed key that the file uses, for an event; "" if none
  double rest_height_m = 0.0;  ///< of B above the ground at the start, on the launcher
  double belly_m = 0.0;        ///< of B above the ground when resting on it
  double approach_height_m = 30.0;
  double approach_mps = 0.0;  ///< default: legs.airspeed_mps
  double glide_rad = rad_from_deg(5.0);
  double flare_m = 1.5;
  double power_off_m = 0.1;
};

void add_waypoint_guidance_parameters(PartSpec& spec);
/// @throws ConfigError for a vehicle without wings, speeds below the stall speed at the turns'
/// bank, a bank beyond the vehicle's, circles smaller than it can fly, or landing keys without a
/// landing
WaypointGuidanceParams read_waypoint_guidance_params(const ParameterSet& parameters,
                                                     const ControllerContext& context);

}  // namespace vinerow::controllers
