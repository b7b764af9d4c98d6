#pragma once
/// The rover in a world of its own.

#include <cmath>

#include "engine/math/angles.h"
#include "tests/vehicles/small_worlds.h"
#include "vehicles/four_wheel_steering_rover/four_wheel_steering_rover.h"

namespace vinerow::vehicles::test {


struct FourWheelRig {
  explicit FourWheelRig(WorldModel model, double yaw_rad = 0.0,
                        const FourWheelSteeringRoverParams& params = {})
      : world_model(std::move(model)),
        world(settings_with_step(1'000'000), world_model),
        rover(params) {
    rover.spawn(world, pose_on_ground(world_model, 0.0, 0.0, yaw_rad, params.com_height_m));
  }

  /// Axle angles in degrees, wheel speeds fl, fr, rl, rr in rad/s.
  void actuate(double front_deg, double rear_deg, const std::array<double, 4>& speeds_radps) {
    rover.actuate(std::array<double, 6>{rad_from_deg(front_deg), rad_from_deg(rear_deg),
                                        speeds_radps[0], speeds_radps[1], speeds_radps[2],
                                        speeds_radps[3]});
  }
  void step() {
    rover.before_physics(now, dt);
    world.step(dt);
    now = now + dt;
    rover.after_physics(now, dt);
  }
  void run(double time_s) {
    for (auto i = std::llround(time_s / dt.s()); i > 0; --i) step();
  }
  const physics::BodyState& body() const { return rover.platform().state().body; }
  const WheelState& wheel(std::size_t i) const { return rover.platform().state().wheels[i]; }
  double energy_J() const { return rover.platform().state().battery.energy_used_J; }
  double yaw_rad() const { return yaw_from_quaternion(body().X_WB.q); }

  WorldModel world_model;
  physics::PhysicsWorld world;
  FourWheelSteeringRover rover;
  Time now;
  Duration dt{1'000'000};
};

}  // namespace vinerow::vehicles::test
