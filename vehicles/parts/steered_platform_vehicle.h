#pragma once
/// Base class of vehicles on one WheeledPlatform with four wheels, with one or two steered axles.
///
/// Actuators: the axle angles ("axle_front_steer_rad", "axle_rear_steer_rad"), then the speeds of
/// the driven wheels in the order of the platform. The directions of the four wheels follow from
/// the axle angles (double_ackermann.h), which servos with a lag and a rate limit set. Links: body,
/// wheels, and a knuckle for each steered wheel, which steers and moves with its wheel but does not
/// spin.

#include <array>
#include <vector>

#include "vehicles/parts/double_ackermann.h"
#include "vehicles/parts/platform_vehicle.h"
#include "vehicles/parts/steering_servo.h"

namespace vinerow::vehicles {

struct SteeringGear {
  TwoAxles axles;
  SteeringServoParams servo;
  double max_axle_steer_rad = 0.0;  ///< to either side
  std::size_t steered_axles = 0;    ///< 1: front, 2: both, 0: none (steers by wheel speeds)
  /// Indices in the platform of the front left, front right, rear left and rear right wheel.
  std::array<std::size_t, 4> wheels = {0, 1, 2, 3};
  /// Index in the platform of each knuckle's wheel, in the order of the links.
  std::vector<std::size_t> knuckles;
};

class SteeredPlatformVehicle : public PlatformVehicle {
 public:
  void actuate(std::span<const double> values) override;
  void before_physics(Time now, Duration dt) override;
  void read_links(std::vector<Pose>& X_WL) const override;

 protected:
  /// Adds the actuators of the axles, ahead of those of the wheels, to vehicle and description.
  /// Called before build_platform(). A vehicle that does not call it steers by wheel speeds.
  void build_steering(SteeringGear gear);

 private:
  void steer(double dt_s);

  SteeringGear gear_;
  std::array<double, 2> command_rad_{};  ///< front, rear; the angles are actuator states
};

}  // namespace vinerow::vehicles
