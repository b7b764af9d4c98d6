#pragma once
/// A vehicle that flies, in a world of its own; FixedWing and Quadrotor.

#include <cmath>
#include <string>
#include <utility>

#include "engine/api/registry.h"
#include "tests/vehicles/small_worlds.h"

namespace vinerow::vehicles::test {

template <class Params, class Vehicle>
struct FlightRig {
  /// @param rest_m  height of B above the ground at the start
  FlightRig(const std::string& name, const Params& the_params, double rest_m, WorldModel model,
            std::int64_t step_ns, double yaw_rad, double gravity)
      : params(the_params),
        world_model(std::move(model)),
        world(settings(step_ns, gravity), world_model),
        vehicle(params, context(name)),
        dt{step_ns} {
    vehicle.spawn(world, pose_on_ground(world_model, 0.0, 0.0, yaw_rad, rest_m));
  }
  FlightRig(const FlightRig&) = delete;

  static physics::PhysicsSettings settings(std::int64_t step_ns, double gravity) {
    physics::PhysicsSettings result = settings_with_step(step_ns);
    result.gravity_mps2 = gravity;
    return result;
  }
  static VehicleContext context(const std::string& name) {
    VehicleContext context;
    context.vehicle = context.part = name;
    return context;
  }

  void step() {
    vehicle.before_physics(now, dt);
    world.step(dt);
    now = now + dt;
    vehicle.after_physics(now, dt);
  }
  void run(double time_s) {
    for (auto i = std::llround(time_s / dt.s()); i > 0; --i) step();
  }
  const physics::BodyState& body() const { return vehicle.body(); }
  Eigen::Vector3d rates_B() const { return body().X_WB.q.conjugate() * body().w_WB_W; }
  std::string crash() const { return std::string(vehicle.crash()); }

  Params params;
  WorldModel world_model;
  physics::PhysicsWorld world;
  Vehicle vehicle;
  Time now;
  Duration dt;
};

}  // namespace vinerow::vehicles::test
