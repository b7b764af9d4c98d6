#pragma once
/// The rover in a world of its own.

#include <array>
#include <utility>

#include "engine/math/angles.h"
#include "tests/vehicles/vehicle_rig.h"
#include "vehicles/four_wheel_steering_rover/four_wheel_steering_rover.h"

namespace vinerow::vehicles::test {

struct FourWheelRig : VehicleRig<FourWheelSteeringRover> {
  explicit FourWheelRig(WorldModel model, double yaw_rad = 0.0,
                        const FourWheelSteeringRoverParams& params = {})
      : VehicleRig(std::move(model), settings_with_step(1'000'000), Duration{1'000'000}, yaw_rad,
                   params.com_height_m, params) {}

  /// Axle angles in degrees, wheel speeds fl, fr, rl, rr in rad/s.
  void actuate(double front_deg, double rear_deg, const std::array<double, 4>& speeds_radps) {
    vehicle.actuate(std::array<double, 6>{rad_from_deg(front_deg), rad_from_deg(rear_deg),
                                          speeds_radps[0], speeds_radps[1], speeds_radps[2],
                                          speeds_radps[3]});
  }
  const physics::BodyState& body() const { return vehicle.platform().state().body; }
  const WheelState& wheel(std::size_t i) const { return vehicle.platform().state().wheels[i]; }
  double energy_J() const { return vehicle.platform().state().battery.energy_used_J; }
  double yaw_rad() const { return yaw_from_quaternion(body().X_WB.q); }
};

}  // namespace vinerow::vehicles::test
