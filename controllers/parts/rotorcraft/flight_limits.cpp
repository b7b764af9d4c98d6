#include "controllers/parts/rotorcraft/flight_limits.h"

#include <algorithm>

#include "engine/api/parameter_table.h"

namespace vinerow::controllers {

const ParameterTable<FlightLimitParams>& flight_limit_table() {
  using P = FlightLimitParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .degrees("tilt_limit_deg", &P::tilt_rad, between(1.0, 60.0),
                   "largest wanted tilt, clamped to that of the vehicle (paper A, section 4.2: 25)")
          .number("min_thrust", "weights", &P::min_thrust, between(0.0, 0.95),
                  "smallest wanted thrust; stopped rotors cannot right the vehicle")
          .number("max_thrust", "weights", &P::max_thrust, between(1.05, 20.0),
                  "largest wanted thrust, clamped to that of the rotors")
          .number("torque_share", "", &P::torque_share, between(0.01, 1.0),
                  "largest wanted torques, as a share of the torque limits at hover")
          .number("correction_speed_mps", "m/s", &P::correction_mps, kPositive,
                  "largest speed towards the reference, in addition to the reference's own")
          .number("climb_correction_mps", "m/s", &P::climb_correction_mps, kPositive,
                  "the same upwards and downwards")
          .number("yaw_rate_limit_degps", "deg/s", &P::yaw_rate_radps, kPositive,
                  "largest yaw rate towards the wanted heading, in addition to the reference's own",
                  kDegrees);
  return table;
}

FlightLimits make_flight_limits(const FlightLimitParams& params, const RotorcraftModel& craft,
                                const RotorMixer& mixer) {
  const double weight_N = craft.mass_kg * craft.gravity_mps2;
  FlightLimits limits;
  limits.tilt_rad = std::min(params.tilt_rad, craft.max_tilt_rad);
  limits.min_thrust_N = params.min_thrust * weight_N;
  limits.max_thrust_N = std::min(params.max_thrust * weight_N, craft.max_thrust_N());
  limits.torque_Nm = params.torque_share * mixer.torque_limits_at_hover();
  limits.correction_mps = params.correction_mps;
  limits.climb_correction_mps = params.climb_correction_mps;
  limits.yaw_rate_radps = params.yaw_rate_radps;
  return limits;
}

}  // namespace vinerow::controllers
