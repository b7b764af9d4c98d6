#include "vehicles/parts/rotor.h"

#include <cmath>

#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {

void RotorParams::validate(const std::string& who) const {
  demand_positive(who, "thrust_coefficient_Ns2", thrust_coefficient_Ns2);
  demand_not_negative(who, "torque_coefficient_Nms2", torque_coefficient_Nms2);
  demand_positive(who, "max_rotor_radps", max_radps);
  demand_not_negative(who, "rotor_rise_lag_s", rise_lag_s);
  demand_not_negative(who, "rotor_fall_lag_s", fall_lag_s);
  demand_not_negative(who, "rotor_inertia_kgm2", inertia_kgm2);
}

SpeedLag::SpeedLag(double lag_s, double dt_s) {
  if (lag_s <= 0.0) return;  // all zero: there at once
  const double x = dt_s / lag_s;
  decay_ = std::exp(-x);
  // expm1 keeps the digits where the lag is long against the step.
  mean1_ = -std::expm1(-x) / x;
  mean2_ = -std::expm1(-2.0 * x) / (2.0 * x);
  mean3_ = -std::expm1(-3.0 * x) / (3.0 * x);
}

SpeedCourse SpeedLag::run(double from_radps, double wanted_radps) const {
  const double u = wanted_radps, d = from_radps - wanted_radps;
  return {
      .end_radps = u + d * decay_,
      .mean_radps = u + d * mean1_,
      .mean_square = u * u + d * (2.0 * u * mean1_ + d * mean2_),
      .mean_cube = u * u * u + d * (3.0 * u * u * mean1_ + d * (3.0 * u * mean2_ + d * mean3_))};
}

}  // namespace vinerow::vehicles
