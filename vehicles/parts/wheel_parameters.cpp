#include "vehicles/parts/wheel_parameters.h"

namespace vinerow::vehicles {

std::vector<ParameterSpec> drive_parameter_specs(const MotorParams& motor, const TyreParams& tyre,
                                                 const BatteryParams& battery) {
  return {
      number_parameter("max_torque_Nm", "Nm", motor.max_torque_Nm, 0.0, 1e5,
                       "largest torque of one wheel motor at the axle; 0 = free wheels"),
      positive_parameter("max_power_W", "W", motor.max_power_W,
                         "largest mechanical power of one wheel motor"),
      positive_parameter("no_load_speed_radps", "rad/s", motor.max_speed_radps,
                         "wheel spin at which the motor has no torque left"),
      number_parameter("motor_lag_s", "s", motor.lag_s, 0.0, 10.0,
                       "time constant of the motor's torque"),
      number_parameter("speed_gain_Nms", "Nm s/rad", motor.speed_gain_Nms, 0.0, 1e5,
                       "proportional gain of the wheel speed controller"),
      number_parameter("speed_integral_gain_Nm", "Nm/rad", motor.speed_integral_gain_Nm, 0.0, 1e6,
                       "integral gain of the wheel speed controller"),
      number_parameter("brake_torque_Nm", "Nm", motor.brake_torque_Nm, 0.0, 1e5,
                       "parking brake of one wheel; 0 = none"),
      number_parameter("brake_below_radps", "rad/s", motor.brake_below_radps, 0.0, 10.0,
                       "the brake closes below this spin when zero is commanded"),
      number_parameter("brake_release_s", "s", motor.brake_release_s, 0.0, 10.0,
                       "the motor must carry the load this long before the brake opens"),
      number_parameter("motor_efficiency", "", motor.efficiency, 0.01, 1.0,
                       "mechanical over electric power when driving"),
      number_parameter("regeneration", "", motor.regeneration, 0.0, 1.0,
                       "share of the braking power that returns to the battery"),
      number_parameter("loss_W_per_Nm2", "W/Nm2", motor.loss_W_per_Nm2, 0.0, 1e3,
                       "copper loss over torque squared"),
      positive_parameter("relaxation_length_m", "m", tyre.relaxation_length_m,
                         "rolling distance in which the tyre force builds up to 63 %"),
      number_parameter("tyre_damping_time_s", "s", tyre.damping_time_s, 0.0, 1.0,
                       "damping of the tyre's deflection over its stiffness"),
      positive_parameter("lateral_friction_ratio", "", tyre.lateral_friction_ratio,
                         "lateral over longitudinal friction of the tyre"),
      positive_parameter("stribeck_speed_mps", "m/s", tyre.stribeck_speed_mps,
                         "sliding speed at which friction has fallen to the sliding value"),
      positive_parameter("battery_capacity_Wh", "Wh", battery.capacity_Wh, "full charge"),
      number_parameter("electronics_W", "W", battery.electronics_W, 0.0, 1e5,
                       "power drawn by computers, sensors and radio"),
  };
}

MotorParams read_motor_params(const ParameterSet& parameters) {
  MotorParams motor;
  motor.max_torque_Nm = parameters.number("max_torque_Nm");
  motor.max_power_W = parameters.number("max_power_W");
  motor.max_speed_radps = parameters.number("no_load_speed_radps");
  motor.lag_s = parameters.number("motor_lag_s");
  motor.speed_gain_Nms = parameters.number("speed_gain_Nms");
  motor.speed_integral_gain_Nm = parameters.number("speed_integral_gain_Nm");
  motor.brake_torque_Nm = parameters.number("brake_torque_Nm");
  motor.brake_below_radps = parameters.number("brake_below_radps");
  motor.brake_release_s = parameters.number("brake_release_s");
  motor.efficiency = parameters.number("motor_efficiency");
  motor.regeneration = parameters.number("regeneration");
  motor.loss_W_per_Nm2 = parameters.number("loss_W_per_Nm2");
  return motor;
}

TyreParams read_tyre_params(const ParameterSet& parameters) {
  TyreParams tyre;
  tyre.relaxation_length_m = parameters.number("relaxation_length_m");
  tyre.damping_time_s = parameters.number("tyre_damping_time_s");
  tyre.lateral_friction_ratio = parameters.number("lateral_friction_ratio");
  tyre.stribeck_speed_mps = parameters.number("stribeck_speed_mps");
  return tyre;
}

BatteryParams read_battery_params(const ParameterSet& parameters) {
  BatteryParams battery;
  battery.capacity_Wh = parameters.number("battery_capacity_Wh");
  battery.electronics_W = parameters.number("electronics_W");
  return battery;
}

double calc_effective_track_m(double track_m, double wheel_base_m) {
  return track_m + wheel_base_m * wheel_base_m / track_m;
}

double calc_small_slip_track_m(double track_m, double wheel_base_m, const Soil& soil) {
  const double ratio = wheel_base_m / track_m;
  return track_m * (1.0 + soil.cornering_stiffness_per_rad / soil.slip_stiffness * ratio * ratio);
}

}  // namespace vinerow::vehicles
