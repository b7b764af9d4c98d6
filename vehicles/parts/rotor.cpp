#include "vehicles/parts/rotor.h"

#include <cmath>

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {

void RotorParams::validate(const std::string& who) const {
  rotor_table().validate(*this, who);
}

const ParameterTable<RotorParams>& rotor_table() {
  using P = RotorParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("thrust_coefficient_Ns2", "N s2", &P::thrust_coefficient_Ns2, kPositive,
                  "thrust of a rotor over its speed squared, at 1.225 kg/m3")
          .number("torque_coefficient_Nms2", "N m s2", &P::torque_coefficient_Nms2,
                  between(0.0, 1.0),
                  "drag torque of a rotor over its speed squared, at 1.225 kg/m3")
          .number("max_rotor_radps", "rad/s", &P::max_radps, kPositive, "largest rotor speed")
          .number("rotor_rise_lag_s", "s", &P::rise_lag_s, between(0.0, 10.0),
                  "time constant of a rotor that speeds up")
          .number("rotor_fall_lag_s", "s", &P::fall_lag_s, between(0.0, 10.0),
                  "time constant of a rotor that slows down")
          .number("rotor_inertia_kgm2", "kg m2", &P::inertia_kgm2, between(0.0, 1.0),
                  "moment of inertia of blades, hub and motor bell about the axis");
  return table;
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
