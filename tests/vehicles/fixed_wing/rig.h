#pragma once
/// A flying wing in a world of its own.

#include <cmath>

#include "engine/math/angles.h"
#include "tests/vehicles/small_worlds.h"
#include "vehicles/fixed_wing/fixed_wing.h"

namespace vinerow::vehicles::test {

/// Trim of the reference of paper A, section 1: level flight at 12 m/s.
struct PageTrim {
  double alpha_rad = rad_from_deg(7.35);
  double throttle = 0.5828;
  double elevator_rad = rad_from_deg(-0.830);
};

/// What it needs to carry a start in the air.
inline FixedWingParams plain_params() {
  FixedWingParams params;
  params.name = "plane";
  return params;
}

struct WingRig {
  explicit WingRig(const FixedWingParams& the_params = plain_params(),
                   WorldModel model = make_flat_world(), std::int64_t step_ns = 1'000'000,
                   double yaw_rad = 0.0, double gravity = kGravity)
      : params(the_params),
        world_model(std::move(model)),
        world(settings(step_ns, gravity), world_model),
        plane(params, context()),
        dt{step_ns} {
    plane.spawn(world, pose_on_ground(world_model, 0.0, 0.0, yaw_rad, params.shape.belly_m));
  }
  static physics::PhysicsSettings settings(std::int64_t step_ns, double gravity) {
    physics::PhysicsSettings result = settings_with_step(step_ns);
    result.gravity_mps2 = gravity;
    return result;
  }
  static VehicleContext context() {
    VehicleContext context;
    context.vehicle = context.part = "plane";
    return context;
  }

  /// In flight along x, nose up by `pitch_rad`, moving level.
  static physics::BodyState level(double height_m, double speed_mps, double pitch_rad) {
    physics::BodyState state;
    state.X_WB.p = {0.0, 0.0, height_m};
    state.X_WB.q = quaternion_from_rpy({0.0, -pitch_rad, 0.0});
    state.v_WB_W = {speed_mps, 0.0, 0.0};
    state.w_WB_W.setZero();
    return state;
  }
  void fly(const physics::BodyState& state, const FixedWing::Actuators& actuators) {
    plane.set_motion(state, actuators);
  }
  void actuate(double throttle, double left_rad, double right_rad) {
    const FixedWing::Actuators values = {throttle, left_rad, right_rad};
    plane.actuate(values);
  }
  void step() {
    plane.before_physics(now, dt);
    world.step(dt);
    now = now + dt;
    plane.after_physics(now, dt);
  }
  void run(double time_s) {
    for (auto i = std::llround(time_s / dt.s()); i > 0; --i) step();
  }
  const physics::BodyState& body() const { return plane.body(); }
  Eigen::Vector3d rates_B() const { return body().X_WB.q.conjugate() * body().w_WB_W; }
  double pitch_rad() const { return -rpy_from_quaternion(body().X_WB.q).pitch_rad; }
  std::string crash() const { return std::string(plane.crash()); }

  FixedWingParams params;
  WorldModel world_model;
  physics::PhysicsWorld world;
  FixedWing plane;
  Time now;
  Duration dt;
};

}  // namespace vinerow::vehicles::test
