// The controller behind its signals: local commands, failures, refusals.

#include "controllers/four_wheel_steering/four_wheel_steering.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/four_wheel_steering/steered_loop.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::four_wheel_steering_test {
namespace {

using Mode = LocalCommand::Mode;

void run(SteeredLoop& loop, double seconds) {
  const double until = loop.time_s() + seconds;
  while (loop.time_s() < until - 1e-9) loop.tick();
}

bool is_standing(const SteeredLoop& loop) {
  for (int i = 2; i < 6; ++i) {
    if (loop.actuators()[i] != 0.0) return false;
  }
  return true;
}

TEST(FourWheelSteering, FollowsNotFasterThanTheLocalPlannerSays) {
  SteeredLoop loop({});
  loop.give_plan(make_straight_plan(30.0));
  loop.give_local({Mode::kFollow, 0.3});
  run(loop, 5.0);
  EXPECT_NEAR(loop.steering("v_des_mps"), 0.3, 1e-12);
  loop.give_local({Mode::kFollow, 5.0});
  run(loop, 5.0);
  EXPECT_NEAR(loop.steering("v_des_mps"), 1.0, 1e-12);
}

TEST(FourWheelSteering, StandsWhileTheLocalPlannerWantsIt) {
  SteeredLoop loop({});
  loop.give_plan(make_straight_plan(30.0));
  run(loop, 4.0);
  EXPECT_FALSE(is_standing(loop));
  const double x = loop.plant().pose().p.x();
  loop.give_local({Mode::kStop});
  run(loop, 2.0);
  EXPECT_TRUE(is_standing(loop));
  // 1 m/s at twice acceleration_mps2 = 1 m/s2 takes half a metre.
  EXPECT_NEAR(loop.plant().pose().p.x() - x, 0.5, 0.03);
  EXPECT_FALSE(loop.finished());
  loop.give_local({Mode::kFollow, 1.0});
  run(loop, 60.0);
  EXPECT_TRUE(loop.finished());
}

TEST(FourWheelSteering, DrivesTheAnglesOfTheLocalPlanner) {
  const double angle = rad_from_deg(15.0);
  SteeredLoop crab({});
  crab.give_local({Mode::kDrive, 0.5, angle, angle});
  run(crab, 10.0);
  EXPECT_NEAR(crab.plant().pose().yaw_rad, 0.0, 1e-9);
  EXPECT_NEAR(std::atan2(crab.plant().pose().p.y(), crab.plant().pose().p.x()), angle, 2e-3);

  SteeredLoop back({});
  back.give_local({Mode::kDrive, -0.4, -angle, angle});
  run(back, 5.0);
  EXPECT_NEAR(back.command().v_mps, -0.4, 1e-9);
  EXPECT_NEAR(back.command().yaw_rate_radps, 0.4 * 2.0 * std::tan(angle) / 1.5, 1e-9);
  EXPECT_LT(back.plant().pose().p.x(), -1.0);

  SteeredLoop cut({});
  cut.give_local({Mode::kDrive, 9.0, 1.0, -1.0});
  run(cut, 10.0);
  EXPECT_NEAR(cut.actuators()[0], rad_from_deg(23.0), 1e-12);
  EXPECT_NEAR(cut.actuators()[1], -rad_from_deg(23.0), 1e-12);
  // Outer wheels at their limit, inner ones in the ratio of row 5 of the reference cases.
  EXPECT_NEAR(cut.actuators()[3], 8.0, 1e-6);
  EXPECT_NEAR(cut.actuators()[2] / cut.actuators()[3], 3.4801 / 5.2446, 3e-5);
}

TEST(FourWheelSteering, TurnsRoundThroughRest) {
  SteeredLoop loop({});
  loop.give_local({Mode::kDrive, 0.5});
  run(loop, 3.0);
  loop.give_local({Mode::kDrive, -0.5});
  double last = 0.5;
  bool stood = false;
  for (int i = 0; i < 150; ++i) {
    loop.tick();
    const double v = loop.steering("v_des_mps");
    EXPECT_LE(std::abs(v - last), 1.0 * 0.02 + 1e-12);
    stood = stood || v == 0.0;
    last = v;
  }
  EXPECT_TRUE(stood);
  EXPECT_EQ(last, -0.5);
}

TEST(FourWheelSteering, TellsWhatItDoes) {
  SteeredLoop loop({});
  loop.give_local({Mode::kDrive, 0.8, 0.2, -0.1});
  run(loop, 5.0);
  const double k = (std::tan(0.2) + std::tan(0.1)) / 1.5, s = 0.5 * (std::tan(0.2) - std::tan(0.1));
  EXPECT_NEAR(loop.steering("front_des_rad"), 0.2, 1e-12);
  EXPECT_NEAR(loop.steering("rear_act_rad"), -0.1, 1e-12);
  EXPECT_NEAR(loop.steering("curvature_per_m"), k / std::sqrt(1 + s * s), 1e-9);
  EXPECT_EQ(loop.steering("qp_status"), 0.0);
  EXPECT_LT(loop.steering("qp_cost"), 1e-12);
  EXPECT_LT(loop.steering("slip_residual_mps"), 1e-8);
  EXPECT_NEAR(loop.command().v_mps, 0.8 / std::sqrt(1 + s * s), 1e-8);
  EXPECT_NEAR(loop.command().yaw_rate_radps, loop.plant().truth().w_WB_B.z(), 1e-8);
}

// Axles that jump (an encoder that fails) leave no wheel speeds within reach: stop, say so once,
// stay.
TEST(FourWheelSteering, StopsSafelyWhereTheQpHasNoSolution) {
  LoopOptions options;
  options.parameters = {{"wheel_acceleration_mps2", 0.6}};
  SteeredLoop loop(options);
  loop.give_plan(make_straight_plan(60.0));
  run(loop, 4.0);
  ASSERT_TRUE(loop.events().empty());
  ASSERT_NEAR(loop.steering("v_des_mps"), 1.0, 1e-9);
  loop.give_local({Mode::kDrive, 1.0, 0.4, -0.4});
  run(loop, 10.0);
  ASSERT_EQ(loop.events().size(), 1u);
  const Event event = loop.events()[0];
  EXPECT_EQ(event.level, Event::Level::kError);
  EXPECT_EQ(event.source, "rover.controller");
  EXPECT_NE(event.text.find("velocity QP: infeasible, slip tolerance 0.005 m/s"), std::string::npos)
      << event.text;
  EXPECT_TRUE(is_standing(loop));
  EXPECT_FALSE(loop.finished());
  EXPECT_EQ(loop.steering("qp_status"), 1.0);
  // Steering is held, and nothing moves it again.
  const double held = loop.actuators()[0];
  loop.give_local({Mode::kFollow, 1.0});
  run(loop, 2.0);
  EXPECT_EQ(loop.actuators()[0], held);
  EXPECT_TRUE(is_standing(loop));
  EXPECT_EQ(loop.events().size(), 1u);
}

TEST(FourWheelSteering, SlowsDownWithoutAJoltInASafeStop) {
  LoopOptions options;
  options.parameters = {{"wheel_acceleration_mps2", 0.6}};
  SteeredLoop loop(options);
  loop.give_plan(make_straight_plan(60.0));
  run(loop, 4.0);
  loop.give_local({Mode::kDrive, 1.0, 0.4, -0.4});
  double last = 5.0;
  while (!is_standing(loop)) {
    loop.tick();
    ASSERT_LT(loop.time_s(), 10.0);
    // 0.6 m/s2 in the QP, 0.5 m/s2 in the stop, on a wheel of 0.2 m.
    EXPECT_NEAR(loop.actuators()[3], last, 0.6 * 0.02 / 0.2 + 1e-6);
    last = loop.actuators()[3];
  }
}

TEST(FourWheelSteering, TrustsEncodersMoreThanItsOwnModel) {
  LoopOptions options;
  options.plant.servo_lag_s = 0.3;
  options.encoders = true;
  SteeredLoop loop(options);
  loop.give_local({Mode::kDrive, 0.5, 0.3, -0.3});
  run(loop, 0.3);
  const double before = loop.plant().front_rad();
  EXPECT_LT(before, 0.25);
  loop.tick();
  EXPECT_EQ(loop.steering("front_act_rad"), before);
}

TEST(FourWheelSteering, AllocatesNothingWithAllItsInputs) {
  Loop loop({.description = make_steered_description(), .tick = Duration{20'000'000}});
  loop.add_controller({"four_wheel_steering", {{"wheel_acceleration_mps2", 3.0}}});
  loop.give_plan(make_omega(1.77));
  NamedValues angles{{"axle_front_steer_rad", "axle_rear_steer_rad"}, {0.0, 0.0}};
  Odometry pose;
  std::size_t allocations = 1;
  for (int i = 0; i < 500; ++i) {
    pose.X_WB.p.x() = 0.02 * i;
    pose.v_WB_B = {1.0, 0.01, 0.0};
    angles.values[0] = 0.02 * std::sin(0.1 * i);
    loop.write("encoders", angles);
    loop.write("local_command",
               LocalCommand{i % 100 < 50 ? Mode::kFollow : Mode::kDrive, 0.8, 0.05, -0.05});
    if (i == 0) {
      loop.step(pose);  // takes the plan
      allocations = 0;
      continue;
    }
    AllocationCounter counter;
    loop.step(pose);
    allocations += counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_TRUE(loop.events().empty());
}

std::string refusal_of(const VehicleDescription& description) {
  try {
    Loop({.description = description}).add_controller({"four_wheel_steering", {}});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(FourWheelSteering, RefusesVehiclesItCannotSteer) {
  EXPECT_EQ(
      refusal_of(make_rover_description()),
      "rover.controller (four_wheel_steering) steers by two axle angles and four wheel speeds "
      "(axle_front_steer_rad, axle_rear_steer_rad, wheel_fl_speed_radps, ...), but vehicle type "
      "'test_rover' has no 'axle_front_steer_rad', only wheel_fl_speed_radps, "
      "wheel_fr_speed_radps, wheel_rl_speed_radps, wheel_rr_speed_radps");
  VehicleDescription vehicle = make_steered_description();
  vehicle.steered->steer_rate_radps = 0.0;
  EXPECT_EQ(refusal_of(vehicle),
            "rover.controller (four_wheel_steering) needs 'steer_rate_radps' > 0, but vehicle type "
            "'test_steered_rover' has 0");
  vehicle.steered.reset();
  EXPECT_EQ(refusal_of(vehicle),
            "rover.controller (four_wheel_steering) needs a vehicle with two steered axles; "
            "vehicle type 'test_steered_rover' has wheels");
  vehicle = make_steered_description();
  vehicle.steered->rear_axle_m = -0.75;
  EXPECT_EQ(refusal_of(vehicle),
            "rover.controller (four_wheel_steering) needs 'rear_axle_m' > 0, but vehicle type "
            "'test_steered_rover' has -0.75");
  vehicle = make_steered_description();
  vehicle.steered->max_axle_steer_rad = 1.4;
  for (int i = 0; i < 2; ++i) vehicle.actuators[i].min = -(vehicle.actuators[i].max = 1.4);
  EXPECT_NE(refusal_of(vehicle).find("axles that turn by 1.4 rad"), std::string::npos);
}

}  // namespace
}  // namespace vinerow::test::four_wheel_steering_test
