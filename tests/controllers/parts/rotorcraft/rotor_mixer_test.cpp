#include "controllers/parts/rotorcraft/rotor_mixer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "tests/controllers/support/quadrotor_sim.h"
#include "tests/support/no_alloc.h"

namespace vinerow::controllers::rotor_mixer_test {
namespace {

RotorcraftModel make_craft(const test::QuadrotorNumbers& numbers) {
  return read_rotorcraft(test::describe(numbers), numbers.gravity_mps2, "drone.controller");
}

/// What rotors at these speeds do, from the numbers alone.
Wrench wrench_by_hand(const test::QuadrotorNumbers& numbers, const std::vector<double>& speeds) {
  Wrench sum;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const double square = speeds[i] * speeds[i];
    const double lift = numbers.thrust_coefficient * square;
    sum.thrust_N += lift;
    sum.torque_B +=
        Eigen::Vector3d(numbers.rotors[i].y_m * lift, -numbers.rotors[i].x_m * lift,
                        numbers.rotors[i].torque_sign * numbers.torque_coefficient * square);
  }
  return sum;
}

std::vector<test::QuadrotorNumbers> layouts() {
  test::QuadrotorNumbers odd = test::make_q4t();  // centre of mass off the middle, one side wider
  odd.rotors[0].x_m += 0.04;
  odd.rotors[2].y_m -= 0.03;
  odd.min_radps = 60.0;
  return {test::make_q4t(), test::with_plus_layout(test::make_q4t()), test::make_m100(), odd};
}

TEST(RotorMixer, IsExactInsideTheLimits) {
  RandomStream random(1, "test", "mixer");
  for (const test::QuadrotorNumbers& numbers : layouts()) {
    const RotorcraftModel craft = make_craft(numbers);
    RotorMixer mixer(craft, "test");
    const double weight = numbers.mass_kg * numbers.gravity_mps2;
    for (int i = 0; i < 200; ++i) {
      // Half of each rotor's hover thrust is more than these ask for.
      const Wrench wanted{
          weight * random.uniform(0.9, 1.2),
          {random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.03, 0.03)}};
      std::vector<double> speeds(4);
      const Wrench reached = mixer.mix(wanted, speeds);
      const Wrench made = wrench_by_hand(numbers, speeds);
      EXPECT_NEAR(made.thrust_N, wanted.thrust_N, 1e-12 * weight);
      EXPECT_LT((made.torque_B - wanted.torque_B).norm(), 1e-13 * weight);
      EXPECT_NEAR(reached.thrust_N, made.thrust_N, 1e-12 * weight);
      EXPECT_LT((reached.torque_B - made.torque_B).norm(), 1e-13 * weight);
    }
  }
}

TEST(RotorMixer, KnowsWhichRotorsTurnFasterToRollPitchAndYaw) {
  RotorMixer mixer(make_craft(test::make_q4t()), "test");
  std::vector<double> speeds(4);               // front left, rear left, rear right, front right
  mixer.mix({20.0, {0.5, 0.0, 0.0}}, speeds);  // left side up
  EXPECT_GT(speeds[0], speeds[3]);
  EXPECT_GT(speeds[1], speeds[2]);
  mixer.mix({20.0, {0.0, 0.5, 0.0}}, speeds);  // nose down
  EXPECT_GT(speeds[1], speeds[0]);
  EXPECT_GT(speeds[2], speeds[3]);
  mixer.mix({20.0, {0.0, 0.0, 0.1}}, speeds);  // to the left, by those whose drag turns so
  EXPECT_GT(speeds[0], speeds[1]);
  EXPECT_GT(speeds[2], speeds[3]);
}

TEST(RotorMixer, KeepsTheDirectionOfRollAndPitchWhateverIsAskedFor) {
  RandomStream random(2, "test", "mixer");
  for (const test::QuadrotorNumbers& numbers : layouts()) {
    RotorMixer mixer(make_craft(numbers), "test");
    for (int i = 0; i < 2000; ++i) {
      const Wrench wanted{
          random.uniform(-50.0, 200.0),
          {random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-3, 3)}};
      std::vector<double> speeds(4);
      const Wrench made = (mixer.mix(wanted, speeds), wrench_by_hand(numbers, speeds));
      for (const double speed : speeds) {
        ASSERT_GE(speed, numbers.min_radps);
        ASSERT_LE(speed, numbers.max_radps);
      }
      const Eigen::Vector2d requested = wanted.torque_B.head<2>(), got = made.torque_B.head<2>();
      const double cross = requested.x() * got.y() - requested.y() * got.x();
      ASSERT_NEAR(cross, 0.0, 1e-10 * requested.norm());
      ASSERT_GT(requested.dot(got), 0.0);
      ASSERT_LE(got.norm(), requested.norm() * (1.0 + 1e-12));
      // Yaw between nothing and what was asked for.
      const double yaw = made.torque_B.z() * (wanted.torque_B.z() > 0.0 ? 1.0 : -1.0);
      ASSERT_GE(yaw, -1e-12);
      ASSERT_LE(yaw, std::abs(wanted.torque_B.z()) + 1e-12);
    }
  }
}

TEST(RotorMixer, GivesUpYawThenThrustThenScalesRollAndPitch) {
  const test::QuadrotorNumbers numbers = test::make_q4t();
  RotorMixer mixer(make_craft(numbers), "test");
  const double max_N = numbers.thrust_coefficient * 640.0 * 640.0, arm = 0.31 * std::sqrt(0.5);
  const double drag_m = numbers.torque_coefficient / numbers.thrust_coefficient;
  std::vector<double> speeds(4);
  // At 4 N a rotor, 3 N of them for roll: 1 N is left for yaw.
  Wrench made =
      (mixer.mix({16.0, {4 * 3.0 * arm, 0, 9.9}}, speeds), wrench_by_hand(numbers, speeds));
  EXPECT_NEAR(made.thrust_N, 16.0, 1e-12);
  EXPECT_NEAR(made.torque_B.x(), 12.0 * arm, 1e-12);
  EXPECT_NEAR(made.torque_B.z(), 4 * 1.0 * drag_m, 1e-12);
  // 6 N of roll at 4 N a rotor: the thrust rises to 6 N a rotor, nothing is left for yaw.
  made = (mixer.mix({16.0, {4 * 6.0 * arm, 0, 9.9}}, speeds), wrench_by_hand(numbers, speeds));
  EXPECT_NEAR(made.thrust_N, 24.0, 1e-11);
  EXPECT_NEAR(made.torque_B.x(), 24.0 * arm, 1e-11);
  EXPECT_NEAR(made.torque_B.z(), 0.0, 1e-12);
  // More than the rotors have: one side stands, the other is at its limit.
  made = (mixer.mix({16.0, {4 * max_N * arm, 0, 0}}, speeds), wrench_by_hand(numbers, speeds));
  EXPECT_NEAR(made.torque_B.x(), 2 * max_N * arm, 1e-10);
  EXPECT_NEAR(made.thrust_N, 2 * max_N, 1e-10);
  EXPECT_NEAR(speeds[2], 0.0, 1e-4);  // the root of a rounding
  EXPECT_NEAR(speeds[0], 640.0, 1e-9);
  // Too much thrust with roll: the roll stays.
  made = (mixer.mix({1e3, {4 * 3.0 * arm, 0, 0}}, speeds), wrench_by_hand(numbers, speeds));
  EXPECT_NEAR(made.torque_B.x(), 12.0 * arm, 1e-11);
  EXPECT_NEAR(made.thrust_N, 4 * (max_N - 3.0), 1e-10);
}

TEST(RotorMixer, TellsTheTorquesThatHoverLeavesRoomFor) {
  const test::QuadrotorNumbers numbers = test::make_q4t();
  RotorMixer mixer(make_craft(numbers), "test");
  const double hover_N = 0.25 * numbers.mass_kg * numbers.gravity_mps2;
  const double arm = 0.31 * std::sqrt(0.5);
  const Eigen::Vector3d limits = mixer.torque_limits_at_hover();
  EXPECT_NEAR(limits.x(), 4 * hover_N * arm, 1e-12);
  EXPECT_NEAR(limits.y(), 4 * hover_N * arm, 1e-12);
  EXPECT_NEAR(limits.z(), 4 * hover_N * numbers.torque_coefficient / numbers.thrust_coefficient,
              1e-12);
}

TEST(RotorMixer, AllocatesNothing) {
  RotorMixer mixer(make_craft(test::make_q4t()), "test");
  std::vector<double> speeds(4);
  std::size_t allocations = 0;
  {
    test::AllocationCounter counter;
    for (int i = 0; i < 100; ++i) mixer.mix({0.4 * i, {0.3 * i, -0.2 * i, 0.01 * i}}, speeds);
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

void expect_refused(const test::QuadrotorNumbers& numbers, const std::string& sentence) {
  try {
    RotorMixer mixer(make_craft(numbers), "drone.controller (test)");
    FAIL() << "must be refused: " << sentence;
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.what(), sentence);
  }
}

TEST(RotorMixer, RefusesRotorsThatCannotSteer) {
  test::QuadrotorNumbers numbers = test::make_q4t();
  for (test::SimRotor& rotor : numbers.rotors) rotor.torque_sign = 1.0;
  expect_refused(numbers,
                 "drone.controller (test): 4 rotors with these places and torque signs cannot make "
                 "thrust and the torques about all three axes independently");
  numbers = test::make_q4t();
  numbers.rotors.pop_back();
  numbers.max_radps = 800.0;
  expect_refused(numbers,
                 "drone.controller (test): 3 rotors with these places and torque signs cannot make "
                 "thrust and the torques about all three axes independently");
  numbers = test::make_q4t();
  for (test::SimRotor& rotor : numbers.rotors) rotor.x_m += 0.5;
  expect_refused(
      numbers,
      "drone.controller (test): rotor 1 would have to pull down when the vehicle hovers; "
      "the rotors must be placed around the centre of mass");
}

}  // namespace
}  // namespace vinerow::controllers::rotor_mixer_test
