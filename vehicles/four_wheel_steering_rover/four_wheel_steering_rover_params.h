#pragma once
/// Parameters of paper A's four-wheel-steering rover. Sources: assets/vehicles/rover_paper_a.yaml.

#include "engine/api/part.h"
#include "engine/math/angles.h"
#include "vehicles/parts/chassis.h"
#include "vehicles/parts/double_ackermann.h"
#include "vehicles/parts/steering_servo.h"

namespace vinerow::vehicles {

struct FourWheelSteeringRoverParams : ChassisParams {
  double max_steer_rad = rad_from_deg(23.0);  ///< paper A, section 1: steering range
  bool limits_wheels = false;  ///< the range is that of the inner wheel, not of the axle
  SteeringServoParams servo;   ///< paper A, section 1: 2 rad/s

  FourWheelSteeringRoverParams();
  /// @throws ConfigError
  void validate() const;

  TwoAxles axles() const;
  /// Largest axle angle, to both sides and for both axles. With `limits_wheels` it is the angle at
  /// which the inner wheel of the tightest turn (axles opposite) is at max_steer_rad: no other pair
  /// of axle angles within it turns a wheel further.
  double max_axle_steer_rad() const;
  /// Radius of that turn, at B: half wheel base / tan(max axle angle).
  double min_turning_radius_m() const;
};

/// Specification, as `vinerow list` shows it.
PartSpec four_wheel_steering_rover_spec();

/// @param parameters  of four_wheel_steering_rover_spec()
FourWheelSteeringRoverParams read_four_wheel_steering_rover_params(const ParameterSet& parameters,
                                                                   const std::string& name);

}  // namespace vinerow::vehicles
