#include "controllers/parts/flight_limits.h"

#include <algorithm>

#include "engine/math/angles.h"

namespace vinerow {

std::vector<ParameterSpec> flight_limit_parameters() {
  return {
      number_parameter("tilt_limit_deg", "deg", 25.0, 1.0, 60.0,
                       "largest wanted tilt (paper A, section 4.2: 25)"),
      number_parameter("min_thrust", "weights", 0.3, 0.0, 0.95,
                       "least wanted thrust; rotors at rest cannot right the vehicle"),
      number_parameter("max_thrust", "weights", 2.0, 1.05, 20.0,
                       "largest wanted thrust, cut to what the rotors have"),
      number_parameter("torque_share", "", 0.7, 0.01, 1.0,
                       "largest wanted torques, of those that hover leaves room for"),
      positive_parameter("correction_speed_mps", "m/s", 2.0,
                         "largest speed towards the reference, beside its own"),
      positive_parameter("climb_correction_mps", "m/s", 1.0, "the same upwards and downwards"),
      positive_parameter("yaw_rate_limit_degps", "deg/s", 60.0,
                         "largest yaw rate towards the wanted heading, beside the reference's own"),
  };
}

FlightLimits read_flight_limits(const ParameterSet& parameters, const RotorcraftModel& craft,
                                const RotorMixer& mixer) {
  const double weight_N = craft.mass_kg * craft.gravity_mps2;
  FlightLimits limits;
  limits.tilt_rad = rad_from_deg(parameters.number("tilt_limit_deg"));
  limits.min_thrust_N = parameters.number("min_thrust") * weight_N;
  limits.max_thrust_N = std::min(parameters.number("max_thrust") * weight_N, craft.max_thrust_N());
  limits.torque_Nm = parameters.number("torque_share") * mixer.torque_limits_at_hover();
  limits.correction_mps = parameters.number("correction_speed_mps");
  limits.climb_correction_mps = parameters.number("climb_correction_mps");
  limits.yaw_rate_radps = rad_from_deg(parameters.number("yaw_rate_limit_degps"));
  return limits;
}

}  // namespace vinerow
