#pragma once
/// A quadrotor in a world of its own.

#include <array>
#include <cmath>
#include <memory>

#include "engine/math/angles.h"
#include "tests/vehicles/flight_rig.h"
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

struct QuadrotorRig : FlightRig<QuadrotorParams, Quadrotor> {
  explicit QuadrotorRig(const QuadrotorParams& the_params = {},
                        WorldModel model = make_flat_world(), std::int64_t step_ns = 1'000'000,
                        double yaw_rad = 0.0, double gravity = kGravity)
      : FlightRig("drone", the_params, the_params.stand_height_m, std::move(model), step_ns,
                  yaw_rad, gravity) {}

  /// In flight, level, at rest, all rotors at one speed.
  void fly(double height_m, double speed_radps) {
    fly(at_height(height_m), {speed_radps, speed_radps, speed_radps, speed_radps});
  }
  void fly(const physics::BodyState& state, const std::array<double, kRotors>& speeds_radps) {
    vehicle.set_motion(state, speeds_radps);
  }
  void actuate(const std::array<double, kRotors>& speeds_radps) { vehicle.actuate(speeds_radps); }
  void actuate(double speed_radps) {
    actuate({speed_radps, speed_radps, speed_radps, speed_radps});
  }
  double tilt_rad() const {
    return std::acos(std::clamp((body().X_WB.q * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  }
};

}  // namespace vinerow::vehicles::test
