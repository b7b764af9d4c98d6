#include "controllers/quadrotor_mpc/quadrotor_mpc_params.h"

#include "engine/math/angles.h"

namespace vinerow {
namespace {

ParameterSpec weights(std::string name, std::string unit, std::vector<double> values, bool positive,
                      std::string description) {
  const int size = static_cast<int>(values.size());
  ParameterSpec spec = number_list_parameter(std::move(name), std::move(unit), std::move(values),
                                             std::move(description), size);
  spec.min = 0.0;
  spec.min_exclusive = positive;
  return spec;
}

template <int kSize>
Eigen::Matrix<double, kSize, 1> read(const ParameterSet& parameters, const char* name) {
  return Eigen::Map<const Eigen::Matrix<double, kSize, 1>>(parameters.numbers(name).data());
}

}  // namespace

std::vector<ParameterSpec> quadrotor_mpc_parameters() {
  return {
      integer_parameter("horizon", 20, 2, 60, "N: ticks of the controller that it looks ahead"),
      weights("position_weight", "1/m2", {40, 60, 120}, true,
              "Q of the position error along the wanted heading, to its left and up"),
      weights("velocity_weight", "s2/m2", {8, 8, 12}, false,
              "Q of the velocity error along, left, up"),
      weights("angle_weight", "1/rad2", {4, 4, 20}, true, "Q of roll, pitch and yaw error"),
      weights("rate_weight", "s2/rad2", {0.3, 0.3, 1}, false, "Q of the rates of roll, pitch, yaw"),
      weights("input_weight", "", {0.02, 0.6, 0.6, 2}, true,
              "R of thrust (1/N2) and torques about x, y, z (1/(N m)2)"),
      number_parameter("tilt_limit_deg", "deg", 25.0, 1.0, 60.0,
                       "limit of the tilt in the prediction, soft; an octagon inside it"),
      positive_parameter("lateral_limit_m", "m", 0.25,
                         "limit of the deviation to the side in the prediction, soft"),
      positive_parameter("altitude_limit_m", "m", 0.15,
                         "limit of the deviation in altitude, soft (paper A: 10 % of 1.5 m)"),
      positive_parameter("speed_limit_mps", "m/s", 0.3,
                         "limit of the deviation in forward speed, soft (paper A: 10 % of 3 m/s)"),
      positive_parameter("deviation_limit_weight", "", 1e3,
                         "cost of leaving the limits of deviation, 1/2 w s^2"),
      positive_parameter("tilt_limit_weight", "1/rad2", 1e6,
                         "cost of leaving the limit of tilt, 1/2 w s^2"),
      number_parameter("torque_share", "", 0.7, 0.05, 1.0,
                       "limit of each torque as a share of what the rotors have in hover"),
      number_parameter("min_thrust", "weights", 0.3, 0.0, 0.95,
                       "least thrust; keeps room for torques"),
      number_parameter("max_thrust", "weights", 2.0, 1.05, 20.0,
                       "largest thrust, cut to what the rotors have"),
      number_parameter("disturbance_s", "s", 0.3, 0.0, 100.0,
                       "time in which an unknown force is learnt; longer for noisy estimates, 0 = "
                       "never (then wind leaves an offset)"),
      boolean_parameter("learn_torque", true,
                        "learn unknown torques too, e.g. of a load beside the centre"),
  };
}

QuadrotorMpcParams read_quadrotor_mpc_params(const ParameterSet& parameters, double period_s) {
  QuadrotorMpcParams params;
  params.horizon = static_cast<int>(parameters.integer("horizon"));
  params.period_s = period_s;
  params.weights.position = read<3>(parameters, "position_weight");
  params.weights.velocity = read<3>(parameters, "velocity_weight");
  params.weights.angle = read<3>(parameters, "angle_weight");
  params.weights.rate = read<3>(parameters, "rate_weight");
  params.weights.input = read<4>(parameters, "input_weight");
  params.limits.tilt_rad = rad_from_deg(parameters.number("tilt_limit_deg"));
  params.limits.lateral_m = parameters.number("lateral_limit_m");
  params.limits.altitude_m = parameters.number("altitude_limit_m");
  params.limits.speed_mps = parameters.number("speed_limit_mps");
  params.deviation_weight = parameters.number("deviation_limit_weight");
  params.tilt_weight = parameters.number("tilt_limit_weight");
  params.torque_share = parameters.number("torque_share");
  params.min_thrust = parameters.number("min_thrust");
  params.max_thrust = parameters.number("max_thrust");
  params.disturbance_s = parameters.number("disturbance_s");
  params.learns_torque = parameters.boolean("learn_torque");
  return params;
}

}  // namespace vinerow
