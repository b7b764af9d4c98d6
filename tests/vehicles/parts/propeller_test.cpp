#include "vehicles/parts/propeller.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"

namespace vinerow::vehicles::propeller_test {
namespace {

TEST(Propeller, PullsAsBernoulliSays) {
  const PropellerParams p;
  // rho / 2 S C ((k d)^2 - V^2), by hand: 0.0192325 (625 d^2 - V^2).
  EXPECT_NEAR(calc_thrust_N(p, 1.225, 0.0, 1.0), 12.0203125, 1e-9);
  EXPECT_NEAR(calc_thrust_N(p, 1.225, 10.0, 0.25), 0.0192325 * (156.25 - 100.0), 1e-12);
  EXPECT_NEAR(calc_thrust_N(p, 0.6125, 10.0, 0.25), 0.5 * 0.0192325 * 56.25, 1e-12);
  EXPECT_NEAR(calc_thrust_N(p, 1.225, 12.5, 0.25), 0.0, 1e-12);
}

TEST(Propeller, BrakesByItsShareWhenIdling) {
  PropellerParams p;
  EXPECT_NEAR(calc_thrust_N(p, 1.225, 12.0, 0.0), -0.0192325 * 144.0, 1e-12);
  p.windmill = 0.0;  // it folds
  EXPECT_EQ(calc_thrust_N(p, 1.225, 12.0, 0.0), 0.0);
  EXPECT_GT(calc_thrust_N(p, 1.225, 12.0, 0.3), 0.0);
}

TEST(Propeller, TurnsTheBodyLeftByItsTorque) {
  PropellerParams p;
  EXPECT_EQ(calc_propeller_load(p, 1.225, 12.0, 0.36).torque_B.norm(), 0.0);
  p.torque_Nm = 0.2;
  const AirLoad load = calc_propeller_load(p, 1.225, 12.0, 0.36);
  EXPECT_NEAR(load.torque_B.x(), -0.072, 1e-12);  // left wing down: about -x
  EXPECT_NEAR(load.force_B.x(), 0.0192325 * (225.0 - 144.0), 1e-12);
}

/// T (k d + V) / 2 is what a disc gives the air: T V and the energy left in the wake,
/// m' (v_e - V)^2 / 2 with m' = T / (v_e - V).
TEST(Propeller, DrawsThePowerOfAnIdealDiscOverItsEfficiency) {
  const PropellerParams p;
  const double T = calc_thrust_N(p, 1.225, 12.0, 0.36), exit = 15.0;
  const double ideal = T * 12.0 + 0.5 * T / (exit - 12.0) * (exit - 12.0) * (exit - 12.0);
  EXPECT_NEAR(calc_propeller_power_W(p, T, 12.0, 0.6), ideal / 0.5, 1e-9);
  EXPECT_EQ(calc_propeller_power_W(p, -1.0, 12.0, 0.1), 0.0);
}

TEST(Propeller, RefusesBadNumbers) {
  PropellerParams p;
  p.efficiency = 0.0;
  try {
    p.validate("plane");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "plane: propulsion_efficiency = 0, must be >= 0.01 and <= 1");
  }
}

}  // namespace
}  // namespace vinerow::vehicles::propeller_test
