#include "controllers/four_wheel_steering/four_wheel_params.h"

namespace vinerow {
namespace {

// The ramp of a swing is not straight in the angle (tan), and feedback needs some of the rate too.
constexpr double kSwingReserve = 1.1;

SpeedRule read_rule(const std::string& name) {
  if (name == "qp_printed") return SpeedRule::kQpPrinted;
  return name == "equal" ? SpeedRule::kEqual : SpeedRule::kQp;
}

}  // namespace

std::vector<ParameterSpec> four_wheel_parameters() {
  return {
      choice_parameter("form", "corrected", {"corrected", "printed"},
                       "steering law: corrected signs and curvature feed-forward, or eq. 24-26 of "
                       "paper A letter by letter (diverges)"),
      boolean_parameter("feed_forward", true,
                        "add the path's curvature (form: corrected); false shows what the paper's "
                        "law leaves in turns"),
      number_parameter("lateral_gain_rad_per_m", "rad/m", 2.0, 0.0, 20.0,
                       "K_s: steering of the virtual wheel per lateral error"),
      number_parameter("heading_gain_per_m", "1/m", 3.0, 0.0, 20.0,
                       "K_theta: curvature per heading error"),
      number_parameter("course_share", "", 0.0, 0.0, 1.0,
                       "share of a heading error that the virtual wheel takes off the direction of "
                       "travel at once; 0 = paper A"),
      number_parameter("slip_learn_s", "s", 0.4, 0.0, 1e3,
                       "time over which side slip and missing curvature are learnt; 0 = off. Needs "
                       "an estimate with lateral velocity and yaw rate"),
      number_parameter(
          "response_s", "s", 0.03, 0.0, 1.0,
          "time by which the vehicle lags behind its steering; the servos' lag is known"),
      positive_parameter("speed_mps", "m/s", 1.0, "speed on straights"),
      positive_parameter("turn_speed_mps", "m/s", 0.8, "speed on bends of less than 20 m radius"),
      positive_parameter("acceleration_mps2", "m/s2", 0.5,
                         "speeding up and planned braking; unplanned braking is twice as hard"),
      positive_parameter("goal_tolerance_m", "m", 0.05,
                         "the mission ends this far before the path's end"),
      choice_parameter("speeds", "qp", {"qp", "qp_printed", "equal"},
                       "wheel speeds: two-sided velocity QP, eq. 30-33 as printed, or all equal"),
      positive_parameter("slip_tolerance_mps", "m/s", 5e-3,
                         "eps of the velocity QP (paper A: 0.001 to 0.01)"),
      positive_parameter("rolling_weight", "", 1e-3,
                         "rho of the velocity QP: weight of the rolling speeds"),
      number_parameter("wheel_acceleration_mps2", "m/s2", 0.0, 0.0, 1e3,
                       "limit of each rim's acceleration inside the QP; 0 = none. Where it leaves "
                       "no solution the vehicle stops"),
  };
}

FourWheelParams read_four_wheel_params(const ParameterSet& parameters,
                                       const SteeredDrive& vehicle, double cycle_s) {
  FourWheelParams params;
  const bool is_printed = parameters.text("form") == "printed";
  params.steering.form = is_printed ? SteeringForm::kPrinted : SteeringForm::kCorrected;
  params.steering.lateral_gain_radpm = parameters.number("lateral_gain_rad_per_m");
  params.steering.heading_gain_per_m = parameters.number("heading_gain_per_m");
  params.steering.course_share = parameters.number("course_share");
  params.steering.max_axle_rad = vehicle.max_axle_steer_rad;
  params.feed_forward = parameters.boolean("feed_forward") && !is_printed;
  params.reference.swing_s = kSwingReserve * vehicle.swing_s();
  // A command is reached at the end of its cycle.
  params.reference.response_s = parameters.number("response_s") + vehicle.steer_lag_s + cycle_s;
  params.drive.speed_mps = parameters.number("speed_mps");
  params.drive.turn_speed_mps = parameters.number("turn_speed_mps");
  params.drive.acceleration_mps2 = parameters.number("acceleration_mps2");
  params.drive.swing_s = params.reference.swing_s;
  params.slip_learn_s = parameters.number("slip_learn_s");
  params.goal_tolerance_m = parameters.number("goal_tolerance_m");
  params.cycle_s = cycle_s;
  params.wheels.rule = read_rule(parameters.text("speeds"));
  params.wheels.qp.slip_mps = parameters.number("slip_tolerance_mps");
  params.wheels.qp.rolling_weight = parameters.number("rolling_weight");
  params.wheels.qp.rim_max_mps = vehicle.rim_max_mps;
  params.wheels.qp.rim_change_max_mps = parameters.number("wheel_acceleration_mps2") * cycle_s;
  params.wheels.stop_mps2 = params.drive.acceleration_mps2;
  params.wheels.cycle_s = cycle_s;
  return params;
}

}  // namespace vinerow
