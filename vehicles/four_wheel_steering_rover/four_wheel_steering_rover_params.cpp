#include "vehicles/four_wheel_steering_rover/four_wheel_steering_rover_params.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {
namespace {

std::string find_fault_in_tightest_turn(const FourWheelSteeringRoverParams& p) {
  if (p.min_turning_radius_m() > 0.5 * p.track_m) return "";
  return fmt::format(
      "max_steer_deg = {:.4g} puts the centre of the tightest turn {:.3g} m beside the centre of "
      "mass, under the wheels of track_m = {:.4g}",
      deg_from_rad(p.max_steer_rad), p.min_turning_radius_m(), p.track_m);
}

const ParameterTable<FourWheelSteeringRoverParams>& four_wheel_steering_rover_table() {
  using P = FourWheelSteeringRoverParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .degrees("max_steer_deg", &P::max_steer_rad, between(1.0, 45.0),
                   "steering range to each side")
          .choice("steer_limit", &P::limits_wheels, {{"axle", false}, {"wheel", true}},
                  "angle that the range limits: the axle's (bicycle) angle, or the inner wheel's "
                  "in the tightest turn")
          .include(&P::servo, steering_servo_table())
          .include(chassis_of, chassis_table())
          .rule(find_fault_in_tightest_turn);
  return table;
}

}  // namespace

FourWheelSteeringRoverParams::FourWheelSteeringRoverParams() {
  wheel_base_m = 1.5;
  track_m = 0.85;
  wheel_radius_m = 0.2;
  tyre_width_m = 0.15;
  wheel_speed_limit_radps = 8.0;
  mass_kg = 240.0;
  com_height_m = 0.42;
  inertia_kgm2 = {22.0, 64.0, 73.0};
  suspension_stiffness_N_per_m = 25000.0;
  suspension_damping_Ns_per_m = 1200.0;
  motor.max_torque_Nm = 120.0;
  motor.max_power_W = 600.0;
  motor.max_speed_radps = 10.0;
  battery = {4000.0, 60.0};
}

void FourWheelSteeringRoverParams::validate() const {
  four_wheel_steering_rover_table().validate(*this, name);
}

TwoAxles FourWheelSteeringRoverParams::axles() const {
  return {0.5 * wheel_base_m, 0.5 * wheel_base_m, track_m};
}

double FourWheelSteeringRoverParams::max_axle_steer_rad() const {
  if (!limits_wheels) return max_steer_rad;
  // tan d_wheel = (L/2) / (R - B/2), tan d_axle = (L/2) / R.
  const double half_base_m = 0.5 * wheel_base_m;
  return std::atan(half_base_m / (half_base_m / std::tan(max_steer_rad) + 0.5 * track_m));
}

double FourWheelSteeringRoverParams::min_turning_radius_m() const {
  return 0.5 * wheel_base_m / std::tan(max_axle_steer_rad());
}

PartSpec four_wheel_steering_rover_spec() {
  PartSpec spec;
  spec.name = "four_wheel_steering_rover";
  spec.description =
      "Paper A's rover with Ackermann steering on both axles and four hub motors, with wheel and "
      "tyre forces";
  spec.writes = {"wheels", "battery", "vehicle_event"};
  four_wheel_steering_rover_table().add_to(spec);
  return spec;
}

FourWheelSteeringRoverParams read_four_wheel_steering_rover_params(const ParameterSet& parameters,
                                                                   const std::string& name) {
  FourWheelSteeringRoverParams p = four_wheel_steering_rover_table().read(parameters, name);
  p.name = name;
  return p;
}

}  // namespace vinerow::vehicles
