#pragma once
/// A vehicle on one WheeledPlatform of four wheels whose front axle, or both axles, steer.
///
/// Actuators: the axle angles ("axle_front_steer_rad", "axle_rear_steer_rad"), then the driven
/// wheels' speeds in the platform's order. The directions of the four wheels follow from the axle
/// angles (double_ackermann.h) behind servos with a lag and a rate limit. Links: body, wheels, and
/// a knuckle for each steered wheel, which steers and moves with its wheel but does not turn with
/// it.

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
  std::size_t steered_axles = 0;    ///< 1: the front one, 2: both, 0: none, by wheel speeds alone
  /// Places in the platform of the front left, front right, rear left and rear right wheel.
  std::array<std::size_t, 4> wheels = {0, 1, 2, 3};
  /// Places in the platform of the wheels of the knuckles, in the order of their links.
  std::vector<std::size_t> knuckles;
};

class SteeredPlatformVehicle : public PlatformVehicle {
 public:
  void actuate(std::span<const double> values) override;
  void before_physics(Time now, Duration dt) override;
  void read_links(std::vector<Pose>& X_WL) const override;

 protected:
  /// Adds the axles' actuators, which stand before those of the wheels, and the description's
  /// record of them. Before build_platform(); a vehicle without it steers by its wheels' speeds.
  void build_steering(SteeringGear gear);

 private:
  void steer(double dt_s);

  SteeringGear gear_;
  std::array<double, 2> command_rad_{};  ///< front, rear; the angles are actuator states
};

}  // namespace vinerow::vehicles
