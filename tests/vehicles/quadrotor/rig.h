#pragma once
/// A quadrotor in a world of its own.

#include <array>
#include <cmath>
#include <memory>

#include "engine/math/angles.h"
#include "tests/vehicles/small_worlds.h"
#include "vehicles/quadrotor/quadrotor.h"

namespace vinerow::vehicles::test {

/// No air: what is left are thrust and weight.
inline QuadrotorParams without_air(QuadrotorParams params = {}) {
  params.rotor_drag_Ns_per_m = 0.0;
  params.body_drag_area_m2 = 0.0;
  params.ground_effect = GroundEffectModel::kNone;
  return params;
}

/// Level and at rest.
inline physics::BodyState at_height(double z) {
  physics::BodyState state;
  state.X_WB.p.z() = z;
  state.v_WB_W.setZero();
  state.w_WB_W.setZero();
  return state;
}

struct QuadrotorRig {
  explicit QuadrotorRig(const QuadrotorParams& the_params = {},
                        WorldModel model = make_flat_world(), std::int64_t step_ns = 1'000'000,
                        double yaw_rad = 0.0, double gravity = kGravity)
      : params(the_params),
        world_model(std::move(model)),
        world(settings(step_ns, gravity), world_model),
        drone(params, context()),
        dt{step_ns} {
    drone.spawn(world, pose_on_ground(world_model, 0.0, 0.0, yaw_rad, params.stand_height_m));
  }
  static physics::PhysicsSettings settings(std::int64_t step_ns, double gravity) {
    physics::PhysicsSettings result = settings_with_step(step_ns);
    result.gravity_mps2 = gravity;
    return result;
  }
  static VehicleContext context() {
    VehicleContext context;
    context.vehicle = context.part = "drone";
    return context;
  }

  /// In flight, level, at rest, all rotors at one speed.
  void fly(double height_m, double speed_radps) {
    fly(at_height(height_m), {speed_radps, speed_radps, speed_radps, speed_radps});
  }
  void fly(const physics::BodyState& state, const std::array<double, kRotors>& speeds_radps) {
    drone.set_motion(state, speeds_radps);
  }
  void actuate(const std::array<double, kRotors>& speeds_radps) { drone.actuate(speeds_radps); }
  void actuate(double speed_radps) {
    actuate({speed_radps, speed_radps, speed_radps, speed_radps});
  }
  void step() {
    drone.before_physics(now, dt);
    world.step(dt);
    now = now + dt;
    drone.after_physics(now, dt);
  }
  void run(double time_s) {
    for (auto i = std::llround(time_s / dt.s()); i > 0; --i) step();
  }
  const physics::BodyState& body() const { return drone.body(); }
  Eigen::Vector3d rates_B() const { return body().X_WB.q.conjugate() * body().w_WB_W; }
  double tilt_rad() const {
    return std::acos(std::clamp((body().X_WB.q * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  }
  std::string crash() const { return std::string(drone.crash()); }

  QuadrotorParams params;
  WorldModel world_model;
  physics::PhysicsWorld world;
  Quadrotor drone;
  Time now;
  Duration dt;
};

}  // namespace vinerow::vehicles::test
