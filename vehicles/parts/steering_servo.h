#pragma once
/// Position servo of a steering axle: first-order lag towards the command, with a rate limit, so
/// that the angle never jumps.
///
///   d angle / dt = clamp((command - angle) / T, -rate, +rate)

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::vehicles {

struct SteeringServoParams {
  double rate_radps = 2.0;  ///< > 0
  double lag_s = 0.05;      ///< T, >= 0
};

/// steer_rate_radps, steer_lag_s
const ParameterTable<SteeringServoParams>& steering_servo_table();

/// Angle at the end of the step: the exact solution below the rate limit, without overshoot for any
/// step. A difference below 1e-9 rad is closed at once, so that a servo comes to rest.
inline double advance_servo(const SteeringServoParams& params, double command_rad, double dt_s,
                            double angle_rad) {
  if (std::abs(command_rad - angle_rad) < 1e-9) return command_rad;
  const double share = params.lag_s > 0.0 ? -std::expm1(-dt_s / params.lag_s) : 1.0;
  const double max_step_rad = params.rate_radps * dt_s;
  return angle_rad + std::clamp(share * (command_rad - angle_rad), -max_step_rad, max_step_rad);
}

}  // namespace vinerow::vehicles
