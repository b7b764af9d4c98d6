#pragma once
/// Fixed-wing vehicle as seen by its controllers and guidance, read from its description.
///
/// Controls: throttle d_t (0..1), elevator d_e and aileron d_a in rad, mixed onto elevons: right =
/// d_e - d_a, left = d_e + d_a (trailing edge down > 0: d_e > 0 pitches down, d_a > 0 rolls right;
/// reference of paper A, section 1). States and signs are those of aviation: x forward, y right, z
/// down; u, v, w of the velocity, p, q, r of the rates, phi, theta, psi with psi clockwise. So from
/// B (x forward, y left, z up): v = -v_y, w = -v_z, q = -w_y, r = -w_z, and psi = -yaw.

#include <string>
#include <vector>

#include "engine/api/vehicle.h"

namespace vinerow::controllers {

struct AircraftControls {
  double throttle = 0.0;
  double elevator_rad = 0.0;
  double aileron_rad = 0.0;
};

/// The vehicle's record, extended by the data that its control needs.
struct Aircraft : FixedWingAircraft {
  std::string type;
  double gravity_mps2 = 9.80665;
  int throttle = 0, elevon_left = 1, elevon_right = 2;  ///< in the actuator vector
  std::vector<ActuatorSpec> actuators{};

  double throttle_min() const { return actuators[static_cast<std::size_t>(throttle)].min; }
  double throttle_max() const { return actuators[static_cast<std::size_t>(throttle)].max; }
  double elevon_min_rad() const { return actuators[static_cast<std::size_t>(elevon_left)].min; }
  double elevon_max_rad() const { return actuators[static_cast<std::size_t>(elevon_left)].max; }

  /// Actuator vector of the controls, not limited.
  /// @param actuator_values  actuators.size() entries
  void mix(const AircraftControls& controls, std::vector<double>& actuator_values) const;
  /// The controls that remain after each actuator is clamped to its range: an elevon at its stop
  /// reduces both elevator and aileron.
  AircraftControls limit(const AircraftControls& controls) const;
};

/// The record and the actuators "throttle", "elevon_left_rad", "elevon_right_rad".
/// @throws ConfigError "plane.controller (trmpc) needs a vehicle with wings; vehicle type
/// 'quadrotor' has rotors"; a number of the record or an actuator is missing
Aircraft read_aircraft(const VehicleDescription& description, double gravity_mps2,
                       const std::string& who);

}  // namespace vinerow::controllers
