#include "vehicles/parts/steering_servo.h"

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {

const ParameterTable<SteeringServoParams>& steering_servo_table() {
  using P = SteeringServoParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("steer_rate_radps", "rad/s", &P::rate_radps, kPositive,
                  "largest rate of an axle angle")
          .number("steer_lag_s", "s", &P::lag_s, between(0.0, 10.0),
                  "time constant of the steering servos");
  return table;
}

}  // namespace vinerow::vehicles
