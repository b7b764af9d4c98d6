#include "vehicles/four_wheel_steering_rover/four_wheel_steering_rover_params.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {

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
  validate_chassis();
  demand_range(name, "max_steer_deg", deg_from_rad(max_steer_rad), 1.0, 45.0);
  demand_positive(name, "steer_rate_radps", servo.rate_radps);
  demand_not_negative(name, "steer_lag_s", servo.lag_s);
  if (min_turning_radius_m() <= 0.5 * track_m) {
    throw ConfigError(fmt::format(
        "{}: max_steer_deg = {:.4g} puts the centre of the tightest turn {:.3g} m beside the "
        "centre of mass, under the wheels of track_m = {:.4g}",
        name, deg_from_rad(max_steer_rad), min_turning_radius_m(), track_m));
  }
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
  const FourWheelSteeringRoverParams d;
  PartSpec spec;
  spec.name = "four_wheel_steering_rover";
  spec.description =
      "Paper A's rover with Ackermann steering on both axles and four hub motors, on the shared "
      "wheel";
  spec.writes = {"wheels", "battery"};
  spec.parameters = {
      number_parameter("max_steer_deg", "deg", deg_from_rad(d.max_steer_rad), 1.0, 45.0,
                       "steering range, both ways"),
      choice_parameter("steer_limit", "axle", {"axle", "wheel"},
                       "whose range that is: of the axle's (bicycle) angle, or of the inner wheel "
                       "in the tightest turn"),
      positive_parameter("steer_rate_radps", "rad/s", d.servo.rate_radps,
                         "largest rate of an axle angle"),
      number_parameter("steer_lag_s", "s", d.servo.lag_s, 0.0, 10.0,
                       "time constant of the steering servos"),
  };
  for (ParameterSpec& shared : chassis_parameter_specs(d)) {
    spec.parameters.push_back(std::move(shared));
  }
  return spec;
}

FourWheelSteeringRoverParams read_four_wheel_steering_rover_params(const ParameterSet& parameters,
                                                                   const std::string& name) {
  FourWheelSteeringRoverParams p;
  read_chassis_params(parameters, name, p);
  p.max_steer_rad = rad_from_deg(parameters.number("max_steer_deg"));
  p.limits_wheels = parameters.text("steer_limit") == "wheel";
  p.servo.rate_radps = parameters.number("steer_rate_radps");
  p.servo.lag_s = parameters.number("steer_lag_s");
  p.validate();
  return p;
}

}  // namespace vinerow::vehicles
