#include "vehicles/parts/motor.h"

#include <algorithm>
#include <cmath>

#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {
namespace {

/// Share of the no-load speed from which the torque falls linearly to zero.
constexpr double kFadeStart = 0.9;

}  // namespace

void MotorParams::validate(const std::string& who) const {
  demand_not_negative(who, "max_torque_Nm", max_torque_Nm);
  demand_positive(who, "max_power_W", max_power_W);
  demand_positive(who, "no_load_speed_radps", max_speed_radps);
  demand_not_negative(who, "motor_lag_s", lag_s);
  demand_not_negative(who, "speed_gain_Nms", speed_gain_Nms);
  demand_not_negative(who, "speed_integral_gain_Nm", speed_integral_gain_Nm);
  demand_not_negative(who, "brake_torque_Nm", brake_torque_Nm);
  demand_not_negative(who, "brake_below_radps", brake_below_radps);
  demand_not_negative(who, "brake_release_s", brake_release_s);
  demand_range(who, "motor_efficiency", efficiency, 0.01, 1.0);
  demand_range(who, "regeneration", regeneration, 0.0, 1.0);
  demand_not_negative(who, "loss_W_per_Nm2", loss_W_per_Nm2);
}

double Motor::driving_limit_Nm(double spin_radps) const {
  const double speed = std::abs(spin_radps);
  double limit = params_.max_torque_Nm;
  if (limit * speed > params_.max_power_W) limit = params_.max_power_W / speed;
  const double fade =
      (params_.max_speed_radps - speed) / ((1.0 - kFadeStart) * params_.max_speed_radps);
  return limit * std::clamp(fade, 0.0, 1.0);
}

double Motor::electric_power_W(double torque_Nm, double spin_radps) const {
  const double mechanical = torque_Nm * spin_radps;
  const double useful =
      mechanical >= 0.0 ? mechanical / params_.efficiency : mechanical * params_.regeneration;
  return useful + params_.loss_W_per_Nm2 * torque_Nm * torque_Nm;
}

MotorStep Motor::begin(double command_radps, double spin_radps, double dt_s,
                       MotorState& state) const {
  MotorStep step;
  step.command_radps = command_radps;
  // Hill hold: a closed brake opens only when the wheel says that the motor carries the load.
  if (command_radps == 0.0) {
    state.braked =
        std::abs(spin_radps) < params_.brake_below_radps && params_.brake_torque_Nm > 0.0;
  }
  const double driving = driving_limit_Nm(spin_radps);
  step.max_Nm = spin_radps >= 0.0 ? driving : params_.max_torque_Nm;
  step.min_Nm = spin_radps <= 0.0 ? -driving : -params_.max_torque_Nm;

  // tau+ = tau + a (u - tau), a = dt / (T + dt); u = kp (omega* - omega+) + i
  const double a = dt_s / (params_.lag_s + dt_s);
  if (state.braked && command_radps == 0.0) {
    state.integral_Nm = 0.0;
    step.constant_Nm = (1.0 - a) * state.torque_Nm;
    return step;
  }
  step.constant_Nm = state.torque_Nm + a * (params_.speed_gain_Nms * command_radps +
                                            state.integral_Nm - state.torque_Nm);
  step.slope_Nms = a * params_.speed_gain_Nms;
  return step;
}

void Motor::finish(const MotorStep& step, double spin_radps, double torque_Nm, double dt_s,
                   MotorState& state) const {
  // The integral rests while the torque is at a limit that the error would push further into.
  const double error = step.command_radps - spin_radps;
  const bool at_max = torque_Nm >= step.max_Nm && error > 0.0;
  const bool at_min = torque_Nm <= step.min_Nm && error < 0.0;
  const bool rests = state.braked && step.command_radps == 0.0;
  if (!rests && !at_max && !at_min) {
    const double change = params_.speed_integral_gain_Nm * error * dt_s;
    state.integral_Nm =
        std::clamp(state.integral_Nm + change, -params_.max_torque_Nm, params_.max_torque_Nm);
  }
  state.torque_Nm = torque_Nm;
  state.power_W = electric_power_W(torque_Nm, spin_radps);
}

void Motor::release_brake(const MotorStep& step, double net_torque_Nm, double dt_s,
                          MotorState& state) const {
  const bool carries = net_torque_Nm * step.command_radps > 0.0;
  state.carried_s = carries ? state.carried_s + dt_s : 0.0;
  if (carries && state.carried_s >= params_.brake_release_s) state.braked = false;
}

}  // namespace vinerow::vehicles
