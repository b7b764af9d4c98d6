#include "controllers/four_wheel_steering/four_wheel_params.h"

#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

// The ramp of a swing is not linear in the angle (tan), and feedback needs part of the rate too.
constexpr double kSwingReserve = 1.1;

}  // namespace

const ParameterTable<FourWheelParams>& four_wheel_table() {
  using P = FourWheelParams;
  const auto steering = [](auto member) { return inside(&P::steering, member); };
  const auto drive = [](auto member) { return inside(&P::drive, member); };
  const auto qp = [](auto member) { return inside(&P::wheels, &WheelSpeedsParams::qp, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("form", steering(&SteeringParams::form),
                  {{"corrected", SteeringForm::kCorrected}, {"printed", SteeringForm::kPrinted}},
                  "steering law: corrected signs and curvature feed-forward, or eq. 24-26 of "
                  "paper A as printed (diverges)")
          .boolean("feed_forward", &P::feed_forward,
                   "add the path's curvature (form: corrected); false shows the error of the "
                   "paper's law in turns")
          .number("lateral_gain_rad_per_m", "rad/m", steering(&SteeringParams::lateral_gain_radpm),
                  between(0.0, 20.0), "K_s: steering of the virtual wheel per lateral error")
          .number("heading_gain_per_m", "1/m", steering(&SteeringParams::heading_gain_per_m),
                  between(0.0, 20.0), "K_theta: curvature per heading error")
          .number("course_share", "", steering(&SteeringParams::course_share), between(0.0, 1.0),
                  "share of a heading error that the virtual wheel subtracts from the direction "
                  "of travel at once; 0 = paper A")
          .number("slip_learn_s", "s", &P::slip_learn_s, between(0.0, 1e3),
                  "time constant of the estimates of side slip and missing curvature; 0 = off. "
                  "Needs an estimate with lateral velocity and yaw rate")
          .number("response_s", "s", &P::response_s, between(0.0, 1.0),
                  "lag of the vehicle behind its steering, without the lag of the servos")
          .number("speed_mps", "m/s", drive(&DriveLimits::speed_mps), kPositive,
                  "speed on straights")
          .number("turn_speed_mps", "m/s", drive(&DriveLimits::turn_speed_mps), kPositive,
                  "speed on curves of less than 20 m radius")
          .number("acceleration_mps2", "m/s2", drive(&DriveLimits::acceleration_mps2), kPositive,
                  "acceleration and planned braking; unplanned braking is twice as hard")
          .number("goal_tolerance_m", "m", &P::goal_tolerance_m, kPositive,
                  "distance before the path's end at which the mission ends")
          .choice("speeds", inside(&P::wheels, &WheelSpeedsParams::rule),
                  {{"qp", SpeedRule::kQp},
                   {"qp_printed", SpeedRule::kQpPrinted},
                   {"equal", SpeedRule::kEqual}},
                  "wheel speeds: two-sided velocity QP, eq. 30-33 as printed, or all equal")
          .number("slip_tolerance_mps", "m/s", qp(&WheelSpeedParams::slip_mps), kPositive,
                  "eps of the velocity QP (paper A: 0.001 to 0.01)")
          .number("rolling_weight", "", qp(&WheelSpeedParams::rolling_weight), kPositive,
                  "rho of the velocity QP: weight of the rolling speeds")
          .number("wheel_acceleration_mps2", "m/s2", &P::wheel_acceleration_mps2, between(0.0, 1e3),
                  "limit of each rim's acceleration inside the QP; 0 = none. If the QP then has "
                  "no solution the vehicle stops")
          .include(&P::watch, path_watch_table());
  return table;
}

FourWheelParams read_four_wheel_params(const ParameterSet& parameters, const SteeredDrive& vehicle,
                                       double cycle_s, const std::string& who) {
  FourWheelParams params = four_wheel_table().read(parameters, who);
  params.steering.max_axle_rad = vehicle.max_axle_steer_rad;
  if (params.steering.form == SteeringForm::kPrinted) params.feed_forward = false;
  params.reference.swing_s = kSwingReserve * vehicle.swing_s();
  // A command is reached at the end of its cycle.
  params.reference.response_s = params.response_s + vehicle.steer_lag_s + cycle_s;
  params.drive.swing_s = params.reference.swing_s;
  params.cycle_s = cycle_s;
  params.wheels.qp.rim_max_mps = vehicle.rim_max_mps;
  params.wheels.qp.rim_change_max_mps = params.wheel_acceleration_mps2 * cycle_s;
  params.wheels.stop_mps2 = params.drive.acceleration_mps2;
  params.wheels.cycle_s = cycle_s;
  return params;
}

}  // namespace vinerow::controllers
