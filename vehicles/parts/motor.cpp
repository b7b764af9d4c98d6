#include "vehicles/parts/motor.h"

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {
namespace {

/// Share of the no-load speed from which the torque falls linearly to zero.
constexpr double kFadeStart = 0.9;

}  // namespace

void MotorParams::validate(const std::string& who) const {
  motor_table().validate(*this, who);
}

const ParameterTable<MotorParams>& motor_table() {
  using P = MotorParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("max_torque_Nm", "Nm", &P::max_torque_Nm, between(0.0, 1e5),
                  "largest torque of one wheel motor at the axle; 0 = free wheels")
          .number("max_power_W", "W", &P::max_power_W, kPositive,
                  "largest mechanical power of one wheel motor")
          .number("no_load_speed_radps", "rad/s", &P::max_speed_radps, kPositive,
                  "wheel spin at which the motor has no torque left")
          .number("motor_lag_s", "s", &P::lag_s, between(0.0, 10.0),
                  "time constant of the motor's torque")
          .number("speed_gain_Nms", "Nm s/rad", &P::speed_gain_Nms, between(0.0, 1e5),
                  "proportional gain of the wheel speed controller")
          .number("speed_integral_gain_Nm", "Nm/rad", &P::speed_integral_gain_Nm, between(0.0, 1e6),
                  "integral gain of the wheel speed controller")
          .number("brake_torque_Nm", "Nm", &P::brake_torque_Nm, between(0.0, 1e5),
                  "parking brake of one wheel; 0 = none")
          .number("brake_below_radps", "rad/s", &P::brake_below_radps, between(0.0, 10.0),
                  "the brake closes below this spin when zero is commanded")
          .number("brake_release_s", "s", &P::brake_release_s, between(0.0, 10.0),
                  "the motor must carry the load this long before the brake opens")
          .number("motor_efficiency", "", &P::efficiency, between(0.01, 1.0),
                  "mechanical over electric power when driving")
          .number("regeneration", "", &P::regeneration, between(0.0, 1.0),
                  "share of the braking power that returns to the battery")
          .number("loss_W_per_Nm2", "W/Nm2", &P::loss_W_per_Nm2, between(0.0, 1e3),
                  "copper loss over torque squared");
  return table;
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
  if (state.without_current) {  // limits of zero: it turns freely but for its brake
    state.braked = params_.brake_torque_Nm > 0.0;
    state.integral_Nm = 0.0;
    return step;
  }
  step.command_radps = command_radps;
  // Hill hold: release_brake() opens a closed brake, once the motor carries the load.
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
