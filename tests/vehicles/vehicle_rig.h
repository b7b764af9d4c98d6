#pragma once
/// A vehicle in a world of its own, stepped as the kernel does it.

#include <cmath>
#include <utility>

#include "engine/api/vehicle.h"
#include "tests/vehicles/small_worlds.h"

namespace vinerow::vehicles::test {

template <class Vehicle>
struct VehicleRig {
  /// @param rest_m        height of B above the ground at the start
  /// @param vehicle_args  of its constructor
  template <class... Args>
  VehicleRig(WorldModel model, const physics::PhysicsSettings& settings, Duration the_dt,
             double yaw_rad, double rest_m, Args&&... vehicle_args)
      : world_model(std::move(model)),
        world(settings, world_model),
        vehicle(std::forward<Args>(vehicle_args)...),
        dt(the_dt) {
    vehicle.spawn(world, pose_on_ground(world_model, 0.0, 0.0, yaw_rad, rest_m));
  }
  VehicleRig(const VehicleRig&) = delete;

  void step() {
    vehicle.before_physics(now, dt);
    world.step(dt);
    now = now + dt;
    vehicle.after_physics(now, dt);
  }
  void run(double time_s) {
    for (auto i = std::llround(time_s / dt.s()); i > 0; --i) step();
  }

  WorldModel world_model;
  physics::PhysicsWorld world;
  Vehicle vehicle;
  Time now;
  Duration dt;
};

}  // namespace vinerow::vehicles::test
