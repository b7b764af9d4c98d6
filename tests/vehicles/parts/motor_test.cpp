#include "vehicles/parts/motor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "vehicles/parts/battery.h"

namespace vinerow::vehicles::motor_test {
namespace {

TEST(Motor, TorqueSpeedCurveHasItsThreeParts) {
  MotorParams p;
  p.max_torque_Nm = 100.0, p.max_power_W = 500.0, p.max_speed_radps = 25.0;
  const Motor motor(p);
  EXPECT_DOUBLE_EQ(motor.driving_limit_Nm(0.0), 100.0);
  EXPECT_DOUBLE_EQ(motor.driving_limit_Nm(5.0), 100.0);   // corner: 500 W / 100 Nm
  EXPECT_DOUBLE_EQ(motor.driving_limit_Nm(-10.0), 50.0);  // 500 W / 10 rad/s
  EXPECT_DOUBLE_EQ(motor.driving_limit_Nm(25.0), 0.0);
  EXPECT_DOUBLE_EQ(motor.driving_limit_Nm(30.0), 0.0);
}

TEST(Motor, ElectricPowerIsMechanicalOverEfficiencyPlusCopper) {
  MotorParams p;
  p.efficiency = 0.8, p.regeneration = 0.5, p.loss_W_per_Nm2 = 0.1;
  const Motor motor(p);
  EXPECT_DOUBLE_EQ(motor.electric_power_W(10.0, 4.0), 40.0 / 0.8 + 10.0);
  EXPECT_DOUBLE_EQ(motor.electric_power_W(-10.0, 4.0), -20.0 + 10.0);
  EXPECT_DOUBLE_EQ(motor.electric_power_W(10.0, 0.0), 10.0);
}

TEST(Motor, TorqueLagIsFirstOrder) {
  // Without feedback (gain only, spin held): tau = kp e (1 - exp(-t / T)).
  MotorParams p;
  p.speed_integral_gain_Nm = 0.0, p.speed_gain_Nms = 10.0, p.lag_s = 0.05;
  const Motor motor(p);
  MotorState state;
  const double dt = 1e-4;
  for (int i = 0; i < 500; ++i) {
    const MotorStep step = motor.begin(3.0, 1.0, dt, state);
    motor.finish(step, 1.0, step.constant_Nm - step.slope_Nms * 1.0, dt, state);
  }
  EXPECT_NEAR(state.torque_Nm, 20.0 * (1.0 - std::exp(-1.0)), 0.02);  // dt / T = 1/500
}

TEST(Motor, BrakeClosesAtZeroCommandAndLowSpinOnly) {
  const Motor motor{MotorParams{}};
  MotorState state;
  motor.begin(0.0, 1.0, 1e-3, state);
  EXPECT_FALSE(state.braked);
  motor.begin(0.0, 0.1, 1e-3, state);
  EXPECT_TRUE(state.braked);
}

TEST(Motor, BrakeHoldsTheHillUntilTheMotorCarries) {
  const Motor motor{MotorParams{}};
  const double load_Nm = -25.0, dt = 1e-3;  // the slope pulls backwards
  MotorState state;
  motor.begin(0.0, 0.0, dt, state);
  ASSERT_TRUE(state.braked);
  int steps = 0;
  while (state.braked && steps < 2000) {
    const MotorStep step = motor.begin(0.15, 0.0, dt, state);
    motor.finish(step, 0.0, step.constant_Nm, dt, state);
    motor.release_brake(step, state.torque_Nm + load_Nm, dt, state);
    ++steps;
  }
  // 40 Nms x 0.15 rad/s at once, and 200 Nm/rad x 0.15 rad/s = 30 Nm each second: 19 Nm take 0.63
  // s, the current's lag 0.01 s, the brake 0.1 s.
  EXPECT_NEAR(steps * dt, 0.743, 0.01);
  EXPECT_GT(state.torque_Nm, 25.0 - 1e-9);
  // Downhill the ground carries from the first step on.
  MotorState downhill;
  motor.begin(0.0, 0.0, dt, downhill);
  for (steps = 0; downhill.braked && steps < 2000; ++steps) {
    const MotorStep step = motor.begin(-0.15, 0.0, dt, downhill);
    motor.finish(step, 0.0, step.constant_Nm, dt, downhill);
    motor.release_brake(step, downhill.torque_Nm + load_Nm, dt, downhill);
  }
  EXPECT_NEAR(steps * dt, 0.1, 0.002);
}

TEST(Motor, IntegralRestsAtTheTorqueLimit) {
  MotorParams p;
  p.max_torque_Nm = 10.0;
  const Motor motor(p);
  MotorState state;
  for (int i = 0; i < 5000; ++i) {
    const MotorStep step = motor.begin(20.0, 0.0, 1e-3, state);
    motor.finish(step, 0.0, step.max_Nm, 1e-3, state);
  }
  EXPECT_LE(std::abs(state.integral_Nm), 10.0);
}

TEST(MotorParams, RejectsEfficiencyAboveOne) {
  MotorParams p;
  p.efficiency = 1.2;
  try {
    p.validate("rover");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "rover: motor_efficiency = 1.2, must be >= 0.01 and <= 1");
  }
}

TEST(Battery, CountsEnergyAndCharge) {
  BatteryParams p{100.0, 20.0};
  BatteryState state;
  for (int i = 0; i < 3600; ++i) advance_battery(p, 30.0, 1.0, state);
  EXPECT_NEAR(state.energy_used_J, 50.0 * 3600.0, 1e-6);
  EXPECT_NEAR(state.charge, 0.5, 1e-12);
  EXPECT_EQ(state.power_W, 50.0);
}

}  // namespace
}  // namespace vinerow::vehicles::motor_test
