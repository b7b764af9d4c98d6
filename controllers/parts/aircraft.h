#pragma once
/// A vehicle on wings as its controllers and guidance see it, read from its description.
///
/// Controls: throttle d_t (0..1), elevator d_e and aileron d_a in rad, mixed onto elevons: right =
/// d_e - d_a, left = d_e + d_a (trailing edge down > 0: d_e > 0 pitches down, d_a > 0 rolls right;
/// reference of paper A, section 1). States and signs are those of aviation: x forward, y right, z
/// down; u, v, w of the velocity, p, q, r of the rates, phi, theta, psi with psi clockwise. So from
/// B (x forward, y left, z up): v = -v_y, w = -v_z, q = -w_y, r = -w_z, and psi = -yaw.

#include <memory>
#include <string>
#include <vector>

#include "engine/api/flight_model.h"
#include "engine/api/vehicle.h"

namespace vinerow {

struct AircraftControls {
  double throttle = 0.0;
  double elevator_rad = 0.0;
  double aileron_rad = 0.0;
};

struct Aircraft {
  std::string type;
  std::shared_ptr<const FlightModel> model;
  double gravity_mps2 = 9.80665;
  double air_density_kgm3 = 1.225;                      ///< "air_density_kgm3", where told
  double wing_area_m2 = 0.0;                            ///< "wing_area_m2"; 0: not told
  double span_m = 0.0;                                  ///< "wing_span_m"
  double cruise_speed_mps = 0.0;                        ///< "cruise_speed_mps"
  double stall_speed_mps = 0.0;                         ///< "stall_speed_mps", level flight
  double max_bank_rad = 0.0;                            ///< "max_bank_rad"
  double throttle_lag_s = 0.0;                          ///< "throttle_lag_s"
  double elevon_lag_s = 0.0;                            ///< "elevon_lag_s"
  int throttle = 0, elevon_left = 1, elevon_right = 2;  ///< in the actuator vector
  std::vector<ActuatorSpec> actuators;

  double throttle_min() const { return actuators[static_cast<std::size_t>(throttle)].min; }
  double throttle_max() const { return actuators[static_cast<std::size_t>(throttle)].max; }
  double elevon_min_rad() const { return actuators[static_cast<std::size_t>(elevon_left)].min; }
  double elevon_max_rad() const { return actuators[static_cast<std::size_t>(elevon_left)].max; }

  /// Actuator vector of the controls, not limited.
  /// @param actuator_values  actuators.size() entries
  void mix(const AircraftControls& controls, std::vector<double>& actuator_values) const;
  /// What is left of the controls when each actuator is cut to its range: an elevon at its stop
  /// takes from both elevator and aileron.
  AircraftControls limit(const AircraftControls& controls) const;
};

/// Actuators "throttle", "elevon_left_rad", "elevon_right_rad" and the numbers above.
/// @throws ConfigError "plane.controller (trmpc): vehicle type 'quadrotor' has no wings" and, by
/// VehicleDescription::number, what it does not tell
Aircraft read_aircraft(const VehicleDescription& description, double gravity_mps2,
                       const std::string& who);

}  // namespace vinerow
