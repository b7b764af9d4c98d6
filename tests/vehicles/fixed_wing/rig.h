#pragma once
/// A flying wing in a world of its own.

#include "engine/math/angles.h"
#include "tests/vehicles/flight_rig.h"
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

struct WingRig : FlightRig<FixedWingParams, FixedWing> {
  explicit WingRig(const FixedWingParams& the_params = plain_params(),
                   WorldModel model = make_flat_world(), std::int64_t step_ns = 1'000'000,
                   double yaw_rad = 0.0, double gravity = kGravity)
      : FlightRig("plane", the_params, the_params.shape.belly_m, std::move(model), step_ns, yaw_rad,
                  gravity) {}

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
    vehicle.set_motion(state, actuators);
  }
  void actuate(double throttle, double left_rad, double right_rad) {
    const FixedWing::Actuators values = {throttle, left_rad, right_rad};
    vehicle.actuate(values);
  }
  double pitch_rad() const { return -rpy_from_quaternion(body().X_WB.q).pitch_rad; }
};

}  // namespace vinerow::vehicles::test
