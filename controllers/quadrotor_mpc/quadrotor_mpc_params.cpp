#include "controllers/quadrotor_mpc/quadrotor_mpc_params.h"

#include "engine/api/parameter_table.h"

namespace vinerow::controllers {

const ParameterTable<QuadrotorMpcParams>& quadrotor_mpc_table() {
  using P = QuadrotorMpcParams;
  const auto weights = [](auto member) { return inside(&P::weights, member); };
  const auto limits = [](auto member) { return inside(&P::limits, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("horizon", &P::horizon, between(2, 60),
                   "N: prediction horizon in ticks of the controller")
          .numbers("position_weight", "1/m2", weights(&MpcWeights::position), kPositive,
                   "Q of the position error along the wanted heading, to its left and up")
          .numbers("velocity_weight", "s2/m2", weights(&MpcWeights::velocity), kNotNegative,
                   "Q of the velocity error along, left, up")
          .numbers("angle_weight", "1/rad2", weights(&MpcWeights::angle), kPositive,
                   "Q of roll, pitch and yaw error")
          .numbers("rate_weight", "s2/rad2", weights(&MpcWeights::rate), kNotNegative,
                   "Q of the rates of roll, pitch, yaw")
          .numbers("input_weight", "", weights(&MpcWeights::input), kPositive,
                   "R of thrust (1/N2) and torques about x, y, z (1/(N m)2)")
          .degrees("tilt_limit_deg", limits(&MpcLimits::tilt_rad), between(1.0, 60.0),
                   "limit of the tilt in the prediction, soft, clamped to that of the vehicle; an "
                   "octagon inside it")
          .number("lateral_limit_m", "m", limits(&MpcLimits::lateral_m), kPositive,
                  "limit of the deviation to the side in the prediction, soft")
          .number("altitude_limit_m", "m", limits(&MpcLimits::altitude_m), kPositive,
                  "limit of the deviation in altitude, soft (paper A: 10 % of 1.5 m)")
          .number("speed_limit_mps", "m/s", limits(&MpcLimits::speed_mps), kPositive,
                  "limit of the deviation in forward speed, soft (paper A: 10 % of 3 m/s)")
          .number("deviation_limit_weight", "", &P::deviation_weight, kPositive,
                  "cost of leaving the limits of deviation, 1/2 w s^2")
          .number("tilt_limit_weight", "1/rad2", &P::tilt_weight, kPositive,
                  "cost of leaving the limit of tilt, 1/2 w s^2")
          .number("torque_share", "", &P::torque_share, between(0.05, 1.0),
                  "limit of each torque, as a share of the torque limits at hover")
          .number("min_thrust", "weights", &P::min_thrust, between(0.0, 0.95),
                  "smallest thrust; leaves a range for torques")
          .number("max_thrust", "weights", &P::max_thrust, between(1.05, 20.0),
                  "largest thrust, clamped to that of the rotors")
          .number(
              "disturbance_s", "s", &P::disturbance_s, between(0.0, 100.0),
              "time constant of the estimate of unknown forces; longer for noisy estimates, 0 = "
              "off (then wind leaves an offset)")
          .boolean("learn_torque", &P::learns_torque,
                   "estimate unknown torques too, e.g. of an off-centre load");
  return table;
}

}  // namespace vinerow::controllers
