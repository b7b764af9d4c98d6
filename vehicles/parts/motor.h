#pragma once
/// Geared electric wheel motor: speed controller, torque-speed curve, first-order torque lag,
/// parking brake, electric power. All values at the wheel's axle, behind the gear.
///
///   commanded      u = kp (omega* - omega) + i,   di/dt = ki (omega* - omega)
///   torque         T dtau/dt = u - tau,           |tau| <= min(tau_max, P_max / |omega|) driving
///   electric power P = tau omega / eta (driving), tau omega eta_r (braking), + r tau^2
///
/// The parking brake closes when zero is commanded near standstill. It opens again only when motor
/// and ground together have pushed in the commanded direction for brake_release_s, so that a
/// vehicle does not roll back when it starts on a slope. Springs close it when the current fails.
///
/// The torque is linear in the new spin until it reaches a limit, so that a wheel solves both
/// together (implicit Euler: stable for any gain and step).

#include <string>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::vehicles {

struct MotorParams {
  double max_torque_Nm = 100.0;           ///< >= 0; 0 = a free wheel
  double max_power_W = 500.0;             ///< mechanical, > 0
  double max_speed_radps = 25.0;          ///< no driving torque beyond
  double lag_s = 0.01;                    ///< T, >= 0
  double speed_gain_Nms = 40.0;           ///< kp, Nm per rad/s, >= 0
  double speed_integral_gain_Nm = 200.0;  ///< ki, Nm per rad, >= 0
  double brake_torque_Nm = 150.0;         ///< parking brake, >= 0
  double brake_below_radps = 0.3;         ///< it closes below this spin when zero is commanded
  double brake_release_s = 0.1;           ///< time for which the motor must carry the load before
                                          ///< the brake opens, >= 0
  double efficiency = 0.85;               ///< eta of motor and gear, (0, 1]
  double regeneration = 0.5;              ///< eta_r, share of braking power recovered, [0, 1]
  double loss_W_per_Nm2 = 0.02;           ///< r, copper loss, >= 0

  /// @throws ConfigError
  void validate(const std::string& who) const;
};

/// max_torque_Nm, max_power_W, no_load_speed_radps, motor_lag_s, gains, brake, efficiencies
const ParameterTable<MotorParams>& motor_table();

struct MotorState {
  double torque_Nm = 0.0;    ///< on the wheel, after lag and limits
  double integral_Nm = 0.0;  ///< of the speed controller
  bool braked = false;       ///< the parking brake is closed
  double carried_s = 0.0;    ///< time for which motor and ground have pushed against the brake in
                             ///< the commanded direction
  double power_W = 0.0;      ///< electric, positive when drawn
  bool without_current = false;  ///< the battery is empty: no torque, the brake is closed
};

/// Torque in the step within the limits: tau = constant_Nm - slope_Nms * omega_new.
struct MotorStep {
  double command_radps = 0.0;
  double constant_Nm = 0.0;
  double slope_Nms = 0.0;
  double min_Nm = 0.0;
  double max_Nm = 0.0;
};

class Motor {
 public:
  explicit Motor(const MotorParams& params) : params_(params) {}

  /// Closes the brake if zero is commanded near standstill, and starts the step.
  MotorStep begin(double command_radps, double spin_radps, double dt_s, MotorState& state) const;
  /// @param spin_radps,torque_Nm  as solved by the wheel
  void finish(const MotorStep& step, double spin_radps, double torque_Nm, double dt_s,
              MotorState& state) const;

  /// Opens the brake if motor and ground together turn the wheel in the commanded direction.
  /// @param net_torque_Nm  of motor and ground on the wheel, which the brake holds
  void release_brake(const MotorStep& step, double net_torque_Nm, double dt_s,
                     MotorState& state) const;

  /// Largest torque in the direction of rotation at this spin, Nm >= 0.
  double driving_limit_Nm(double spin_radps) const;
  double electric_power_W(double torque_Nm, double spin_radps) const;

  const MotorParams& params() const { return params_; }

 private:
  MotorParams params_;
};

}  // namespace vinerow::vehicles
