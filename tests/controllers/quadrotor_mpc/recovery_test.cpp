// Starts outside the limits, saturated rotors, estimates that are no numbers: soft limits take
// over, the controller reports it once, the vehicle recovers.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "engine/math/angles.h"
#include "tests/controllers/quadrotor_mpc/mpc_flight.h"

namespace vinerow::test::recovery_test {
namespace {

/// Flies on and checks at every tick what must never be.
void run_checked(QuadrotorLoop& loop, double until_s,
                 const QuadrotorNumbers& numbers = make_q4t()) {
  while (loop.time_s() < until_s - 1e-9) {
    loop.tick();
    const QuadrotorState& state = loop.sim().state();
    ASSERT_TRUE(state.p_W.allFinite() && state.v_W.allFinite() && state.w_B.allFinite());
    for (const double speed : loop.actuators()) {
      ASSERT_TRUE(speed >= numbers.min_radps && speed <= numbers.max_radps) << speed;
    }
    // 70 % of what hover leaves room for: four rotors at their thrust in hover, with the arm of the
    // X layout or the arm of the drag torque.
    if (numbers.max_radps == 640.0) {
      const double hover_Nm = 0.7 * 2.0 * 9.80665 * 0.31 / std::sqrt(2.0) + 1e-9;
      ASSERT_LE(std::abs(loop.value("wrench", "wanted_torque_x_Nm")), hover_Nm);
      ASSERT_LE(std::abs(loop.value("wrench", "wanted_torque_y_Nm")), hover_Nm);
      ASSERT_LE(std::abs(loop.value("wrench", "wanted_torque_z_Nm")),
                0.7 * 2.0 * 9.80665 * 1.32e-6 / 5.98e-5 + 1e-9);
      ASSERT_LE(loop.value("wrench", "wanted_thrust_N"), 2.0 * 2.0 * 9.80665 + 1e-9);
    }
    ASSERT_GE(loop.value("wrench", "wanted_thrust_N"), 0.0);
  }
}

TEST(QuadrotorMpcRecovery, ComesBackFrom40DegreesTwoMetresAndFiveMetresPerSecond) {
  for (int i = 0; i < 8; ++i) {
    const double towards = 0.25 * kPi * i;
    const Eigen::Vector3d side(std::cos(towards), std::sin(towards), 0.0);
    MpcSetup setup;
    setup.path = hover_at({0, 0, 5});
    QuadrotorLoop loop(setup);
    loop.sim().state().p_W += 2.0 * side;
    loop.sim().state().v_W = 5.0 * side;
    loop.sim().state().q_WB = Eigen::AngleAxisd(rad_from_deg(40.0), side);
    run_checked(loop, 8.0);
    EXPECT_LT(loop.path_error().norm(), 0.02) << i;
    EXPECT_NEAR(loop.sim().state().p_W.z(), 5.0, 0.02);
    ASSERT_EQ(loop.events().size(), 2u) << i;
    EXPECT_EQ(loop.events()[0].text.find("state outside its bounds: tilt 40.0 deg of 25"), 0u)
        << loop.events()[0].text;
    EXPECT_NE(loop.events()[0].text.find("; soft constraints take over"), std::string::npos);
    EXPECT_EQ(loop.events()[1].text.find("state back inside its bounds after "), 0u)
        << loop.events()[1].text;
    EXPECT_EQ(loop.value("mpc", "soft_violation"), 0.0);
  }
}

TEST(QuadrotorMpcRecovery, TellsWhatIsOutsideItsBounds) {
  MpcSetup setup;
  setup.path = hover_at({0, 0, 5}, 0.5 * kPi);
  QuadrotorLoop loop(setup);
  loop.sim().state().p_W += Eigen::Vector3d(-2.0, 0.0, 0.4);  // to the left of the heading
  loop.tick();
  ASSERT_EQ(loop.events().size(), 1u);
  EXPECT_EQ(loop.events()[0].text,
            "state outside its bounds: lateral 2.00 m of 0.25, altitude 0.40 m of 0.15; soft "
            "constraints take over");
}

TEST(QuadrotorMpcRecovery, KeepsTheTiltWhileItComesFromTheSide) {
  for (const double towards : {0.0, 0.25 * kPi, 0.5 * kPi, 0.7 * kPi}) {
    MpcSetup setup;
    setup.path = hover_at({0, 0, 5});
    QuadrotorLoop loop(setup);
    loop.sim().state().p_W += 3.0 * Eigen::Vector3d(std::cos(towards), std::sin(towards), 0.0);
    double tilt = 0.0;
    while (loop.time_s() < 6.0) {
      loop.tick();
      tilt = std::max(tilt, loop.sim().tilt_rad());
    }
    // The octagon is soft, and two rotors that speed up by less than the other two slow down leave
    // a momentum that turns the body: the linear model has it in its own yaw torque only.
    EXPECT_LT(tilt, rad_from_deg(28.0));
    EXPECT_GT(tilt, rad_from_deg(15.0));
    EXPECT_LT(loop.path_error().norm(), 0.02);
  }
}

TEST(QuadrotorMpcRecovery, ComesFromFarAwayAndFromHeadDown) {
  MpcSetup setup;
  setup.path = hover_at({0, 0, 50});
  QuadrotorLoop far(setup);
  far.sim().state().p_W += Eigen::Vector3d(-20.0, 15.0, -5.0);
  run_checked(far, 40.0);
  EXPECT_LT(far.path_error().norm(), 0.02);
  QuadrotorLoop turned(setup);
  turned.sim().state().q_WB = Eigen::AngleAxisd(2.6, Eigen::Vector3d(1, 1, 0).normalized());
  run_checked(turned, 15.0);
  EXPECT_LT(turned.path_error().norm(), 0.02);
}

TEST(QuadrotorMpcRecovery, TurnsRoundToTheWantedHeading) {
  for (const double yaw : {3.0, -3.0, 1.5}) {
    MpcSetup setup;
    setup.path = hover_at({0, 0, 5}, yaw);
    QuadrotorLoop loop(setup);
    loop.sim().state().q_WB.setIdentity();
    run_checked(loop, 8.0);
    EXPECT_NEAR(std::remainder(yaw_from_quaternion(loop.sim().state().q_WB) - yaw, 2.0 * kPi), 0.0,
                1e-3);
    EXPECT_LT(loop.path_error().norm(), 0.02);
  }
}

// Rotors that lift little more than the weight, and a reference that wants 3 m up at once.
TEST(QuadrotorMpcRecovery, KeepsUprightWhenTheRotorsAreAtTheirLimit) {
  QuadrotorNumbers weak = make_q4t();
  weak.max_radps = 310.0;  // 1.17 weights
  MpcSetup setup;
  setup.numbers = weak;
  setup.path = hover_at({0, 0, 5});
  QuadrotorLoop loop(setup);
  loop.sim().state().p_W += Eigen::Vector3d(2.0, 1.0, -3.0);
  double fastest = 0.0;
  while (loop.time_s() < 12.0) {
    run_checked(loop, loop.time_s() + 0.05, weak);
    for (const double speed : loop.actuators()) fastest = std::max(fastest, speed);
    ASSERT_LT(loop.sim().tilt_rad(), rad_from_deg(32.0));
  }
  EXPECT_EQ(fastest, 310.0);
  EXPECT_LT(loop.path_error().norm(), 0.02);
}

TEST(QuadrotorMpcRecovery, KeepsTheLastWrenchWhileTheEstimateIsNoNumber) {
  MpcSetup setup;
  setup.path = hover_at({0, 0, 5});
  QuadrotorLoop loop(setup);
  bool is_bad = false;
  loop.set_estimate([&is_bad](Odometry& estimate) {
    if (is_bad) estimate.v_WB_B.y() = std::nan("");
  });
  run_checked(loop, 1.0);
  is_bad = true;
  run_checked(loop, 1.5);
  EXPECT_NEAR(loop.value("wrench", "wanted_thrust_N"), 2.0 * 9.80665, 1e-6);
  is_bad = false;
  run_checked(loop, 3.0);
  EXPECT_LT(loop.path_error().norm(), 1e-3);
  ASSERT_EQ(loop.events().size(), 2u);
  EXPECT_EQ(loop.events()[0].text,
            "no optimal inputs (QP: invalid input): the last valid ones are used");
  EXPECT_EQ(loop.events()[1].text, "optimal inputs again");
}

TEST(QuadrotorMpcRecovery, LeavesTheGroundWithoutLearningWhatItCarries) {
  MpcSetup setup;
  setup.phase = [](double) { return Phase::kTakeOff; };
  setup.path = [](double t) {
    // Two seconds of standing, then up with 0.5 m/s2, 0.5 m/s.
    TrajectoryPoint point;
    const double s = std::max(t - 2.0, 0.0);
    point.a_W.z() = s > 0.0 && s < 1.0 ? 0.5 : 0.0;
    point.v_W.z() = std::min(0.5 * s, 0.5);
    point.p_W.z() = s < 1.0 ? 0.25 * s * s : 0.5 * s - 0.25;
    return point;
  };
  QuadrotorLoop loop(setup);
  loop.sim().set_floor(0.0);
  loop.sim().state().rotors_radps.setZero();
  double off = 0.0;
  while (loop.time_s() < 6.0) {
    loop.tick();
    off = std::max(off, std::abs(loop.path_error().z()));
  }
  EXPECT_LT(off, 0.03);
  EXPECT_LT(std::abs(loop.path_error().z()), 2e-3);
  EXPECT_TRUE(loop.events().empty());
}

TEST(QuadrotorMpcRecovery, StandsOnTheGroundWhileALandingStillAsksForLess) {
  MpcSetup setup;
  setup.phase = [](double) { return Phase::kLand; };
  setup.path = [](double t) {
    TrajectoryPoint point;
    point.v_W.z() = -0.5;
    point.p_W.z() = 1.0 - 0.5 * t;
    return point;
  };
  QuadrotorLoop loop(setup);
  loop.sim().set_floor(0.0);
  run_checked(loop, 4.0);
  EXPECT_EQ(loop.sim().state().p_W.z(), 0.0);
  EXPECT_LT(loop.sim().state().p_W.head<2>().norm(), 0.01);
  EXPECT_TRUE(loop.events().empty());
}

}  // namespace
}  // namespace vinerow::test::recovery_test
