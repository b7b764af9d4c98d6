#include "vehicles/parts/tyre.h"

#include <cmath>

#include "engine/api/parameter_table.h"

// Derivation. The equation of tyre.h in implicit Euler, with h = dt / L, xi at the start and xi+ at
// the end of the step, and Lambda_i from the velocities at the start:
//
//   xi+ = xi + h (-v_s - Lambda xi+)   =>   xi+ = gain (xi - h v_s),  gain = 1 / (1 + h Lambda),
//   F   = N c (xi+ + tau (xi+ - xi) / dt).
//
// v_sx = v_x - R omega+ is linear in the new spin omega+, and so is F_x = fx0 + fx1 omega+, which
// the wheel solves together with its motor (wheel.cpp). Last, xi+ and F are scaled back to the
// ellipse (F_x / mu_x)^2 + (F_y / mu_y)^2 <= N^2 with the peak friction.

namespace vinerow::vehicles {
namespace {

/// Lambda = |V_r| rho / (1 - exp(-rho)), without division by zero at either end.
/// @param sliding_mps  rho |V_r|
double calc_relaxation_speed(double rolling_mps, double sliding_mps) {
  // Below, the series 1 + rho / 2 is off by rho^2 / 12 = 1e-11; above, exp(-rho) is below 1e-17 and
  // rho / (1 - exp(-rho)) = rho to the last digit.
  constexpr double kSmallRho = 1e-5, kLargeRho = 40.0;
  // 1 - exp(-rho) loses digits for small rho only (one at 0.1); expm1 costs three times as much.
  constexpr double kExpm1Rho = 0.1;
  if (sliding_mps <= kSmallRho * rolling_mps) return rolling_mps + 0.5 * sliding_mps;
  if (sliding_mps > kLargeRho * rolling_mps) return sliding_mps;
  const double rho = sliding_mps / rolling_mps;
  return sliding_mps / (rho > kExpm1Rho ? 1.0 - std::exp(-rho) : -std::expm1(-rho));
}

/// Length of (x, y) without hypot's protection from overflow: speeds and ratios are moderate.
double length_of(double x, double y) {
  return std::sqrt(x * x + y * y);
}

}  // namespace

void TyreParams::validate(const std::string& who) const {
  tyre_table().validate(*this, who);
}

const ParameterTable<TyreParams>& tyre_table() {
  using P = TyreParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("relaxation_length_m", "m", &P::relaxation_length_m, kPositive,
                  "rolling distance in which the tyre force builds up to 63 %")
          .number("tyre_damping_time_s", "s", &P::damping_time_s, between(0.0, 1.0),
                  "damping of the tyre's deflection over its stiffness")
          .number("lateral_friction_ratio", "", &P::lateral_friction_ratio, kPositive,
                  "lateral over longitudinal friction of the tyre")
          .number("stribeck_speed_mps", "m/s", &P::stribeck_speed_mps, kPositive,
                  "sliding speed at which friction has fallen to the sliding value");
  return table;
}

double Tyre::calc_friction(const Soil& soil, double sliding_speed_mps, double stribeck_mps) {
  const double ratio = sliding_speed_mps / stribeck_mps;
  return soil.sliding_friction +
         (soil.peak_friction - soil.sliding_friction) * std::exp(-ratio * ratio);
}

TyreStep Tyre::begin(const TyreState& state, const Eigen::Vector2d& velocity_C, double spin_radps,
                     double load_N, const Soil& soil, double dt_s) const {
  const double lateral = params_.lateral_friction_ratio;
  TyreStep step;
  step.load_N = load_N;
  step.velocity = velocity_C;
  step.stiffness = {soil.slip_stiffness, soil.cornering_stiffness_per_rad};
  step.peak = {soil.peak_friction, soil.peak_friction * lateral};

  // Lambda_i = relaxation speed with rho_i |V_r| = c_i s / mu_i^2, from the spin at the start.
  const double v_sx = velocity_C.x() - radius_m_ * spin_radps;
  const double v_sy = velocity_C.y();
  const double rolling = std::abs(radius_m_ * spin_radps);
  const double mu_x = calc_friction(soil, length_of(v_sx, v_sy), params_.stribeck_speed_mps);
  const double mu_y = mu_x * lateral;
  const double s = length_of(mu_x * v_sx, mu_y * v_sy);
  const double relax_x = calc_relaxation_speed(rolling, step.stiffness.x() * s / (mu_x * mu_x));
  const double relax_y = calc_relaxation_speed(rolling, step.stiffness.y() * s / (mu_y * mu_y));

  // Implicit Euler is stable for any speed and step.
  const double h = dt_s / params_.relaxation_length_m;
  step.gain = {1.0 / (1.0 + h * relax_x), 1.0 / (1.0 + h * relax_y)};

  // F_x = N c (per_xi xi+ - tau / dt xi),  per_xi = 1 + tau / dt,
  // xi+ = gain (xi - h v_x) + gain h R omega+.
  const double scale = load_N * step.stiffness.x();
  const double per_xi = 1.0 + params_.damping_time_s / dt_s;
  const double xi_at_zero_spin = step.gain.x() * (state.xi.x() - h * velocity_C.x());
  step.fx0_N = scale * (per_xi * xi_at_zero_spin - (params_.damping_time_s / dt_s) * state.xi.x());
  step.fx1_Ns = scale * per_xi * step.gain.x() * h * radius_m_;
  return step;
}

Eigen::Vector2d Tyre::finish(const TyreStep& step, double spin_radps, double dt_s,
                             TyreState& state) const {
  const double h = dt_s / params_.relaxation_length_m;
  const Eigen::Vector2d sliding(step.velocity.x() - radius_m_ * spin_radps, step.velocity.y());
  Eigen::Vector2d xi = step.gain.cwiseProduct(state.xi - h * sliding);

  // In steady state the spring alone stays inside the ellipse. A change of friction or direction
  // within a step can push it out, and the damper adds to it: first xi, then the sum is cut.
  const Eigen::Vector2d unit = step.stiffness.cwiseQuotient(step.peak);
  const double spring = unit.cwiseProduct(xi).norm();
  if (spring > 1.0) xi /= spring;
  Eigen::Vector2d ratio =
      step.stiffness.cwiseProduct(xi + (params_.damping_time_s / dt_s) * (xi - state.xi));
  const double total = ratio.cwiseQuotient(step.peak).norm();
  if (total > 1.0) ratio /= total;
  state.xi = xi;
  return step.load_N * ratio;
}

}  // namespace vinerow::vehicles
