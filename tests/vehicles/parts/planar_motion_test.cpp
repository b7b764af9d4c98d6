#include "vehicles/parts/planar_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::vehicles::planar_motion_test {
namespace {

TEST(PlanarMotion, QuarterCircleIsExact) {
  PlanarState state;
  set_planar_twist(0.5, 1.5, 1.0, state);  // v = 1, w = 1: radius 1
  const int steps = 1000;
  for (int i = 0; i < steps; ++i) advance_planar(0.5 * kPi / steps, state);
  EXPECT_NEAR(state.p_W.x(), 1.0, 1e-13);  // round-off of 1000 additions
  EXPECT_NEAR(state.p_W.y(), 1.0, 1e-13);
  EXPECT_NEAR(state.yaw_rad, 0.5 * kPi, 1e-13);
}

TEST(PlanarMotion, OneStepEqualsManyAtAnyYawRate) {
  for (const double w : {0.0, 1e-9, 1e-3, 0.7, -1.944, 12.0}) {
    PlanarState one, many;
    set_planar_twist(1.9 - 0.5 * w, 1.9 + 0.5 * w, 1.0, one);
    many = one;
    advance_planar(0.025, one);
    for (int i = 0; i < 25; ++i) advance_planar(0.001, many);
    EXPECT_NEAR((one.p_W - many.p_W).norm(), 0.0, 1e-15) << w;
    EXPECT_NEAR(one.yaw_rad, many.yaw_rad, 1e-15) << w;
  }
}

}  // namespace
}  // namespace vinerow::vehicles::planar_motion_test
