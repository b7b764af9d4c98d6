#include <gtest/gtest.h>

#include <cmath>

#include "controllers/quadrotor_pid/attitude_law.h"
#include "controllers/quadrotor_pid/position_law.h"
#include "controllers/quadrotor_pid/rate_law.h"
#include "engine/math/angles.h"
#include "engine/math/pose.h"
#include "tests/controllers/support/quadrotor_loop.h"

namespace vinerow::test::quadrotor_pid_test {
namespace {

const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

controllers::RotorcraftModel make_craft() {
  return controllers::read_rotorcraft(describe(make_q4t()), 9.80665, "test");
}

controllers::PositionParams make_params() {
  controllers::PositionParams params;
  params.velocity_d.setZero();
  params.tilt_limit_rad = rad_from_deg(25.0);
  return params;
}

TEST(PositionLaw, FeedsTheReferenceForward) {
  const controllers::RotorcraftModel craft = make_craft();
  controllers::PositionLaw law(craft, make_params());
  TrajectoryPoint at;
  at.p_W = {1, 2, 3};
  at.v_W = {3, 0, 0};
  at.a_W = {0, 1.5, 0.2};
  // On the spot: exactly the force that the reference takes.
  const Eigen::Vector3d F = law.step(at, at.p_W, at.v_W, 0.0, true);
  const Eigen::Vector3d expected(0.3 * 3.0, 2.0 * 1.5, 2.0 * (9.80665 + 0.2));
  EXPECT_LT((F - expected).norm(), 1e-12);
  EXPECT_EQ(law.integral_mps2(), Eigen::Vector3d::Zero());
}

TEST(PositionLaw, CutsTiltBeforeHeightAndKeepsTheDirection) {
  controllers::PositionLaw law(make_craft(), make_params());
  TrajectoryPoint at;
  at.p_W = {30, 40, 0};
  const Eigen::Vector3d F = law.step(at, Eigen::Vector3d::Zero(), {-9, -12, 0}, 0.0, true);
  EXPECT_NEAR(F.z(), 2.0 * 9.80665, 1e-12);
  EXPECT_NEAR(F.head<2>().norm() / F.z(), std::tan(rad_from_deg(25.0)), 1e-12);
  EXPECT_NEAR(F.x() / F.y(), 0.75, 1e-12);
  // At the thrust's limit the height comes first.
  at.p_W.z() = 100.0;
  const Eigen::Vector3d up = law.step(at, Eigen::Vector3d::Zero(), {-9, -12, -20}, 0.0, true);
  EXPECT_NEAR(up.z(), 40.0, 1e-12);
  EXPECT_NEAR(up.head<2>().norm(), 0.0, 1e-6);
}

TEST(PositionLaw, DoesNotWindUpAtItsLimits) {
  const controllers::PositionParams params = make_params();
  controllers::PositionLaw law(make_craft(), params);
  TrajectoryPoint at;
  at.p_W = {30, 40, 0};
  const Eigen::Vector3d here = Eigen::Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) law.step(at, here, {-9, -12, 0}, 0.0, true);
  EXPECT_LT(law.integral_mps2().norm(), 1e-12);
  // Thrust that the rotors did not reach stops the growth upwards, not downwards.
  at.p_W = {0, 0, 0.5};
  for (int i = 0; i < 100; ++i) law.step(at, here, here, 3.0, true);
  EXPECT_EQ(law.integral_mps2().z(), 0.0);
  at.p_W = {0, 0, -0.5};
  for (int i = 0; i < 100; ++i) law.step(at, here, here, 3.0, true);
  const double expected =
      -100 * params.period_s * params.velocity_i_per_s2.y() * params.position_p_per_s.y() * 0.5;
  EXPECT_NEAR(law.integral_mps2().z(), expected, 1e-12);
  // On the ground it rests.
  const Eigen::Vector3d before = law.integral_mps2();
  law.step(at, here, here, 0.0, false);
  EXPECT_EQ(law.integral_mps2(), before);
}

TEST(AttitudeLaw, PointsThrustAndNoseWhereWanted) {
  const Eigen::Vector3d F(3, -2, 18);
  for (const double yaw : {0.0, 1.0, 3.0, -2.5}) {
    const Eigen::Quaterniond q = controllers::calc_wanted_attitude(F, yaw);
    EXPECT_LT((q * kZ - F.normalized()).norm(), 1e-12);
    const Eigen::Vector3d x = q * Eigen::Vector3d::UnitX();
    EXPECT_NEAR(std::atan2(x.y(), x.x()), yaw, 1e-12);
  }
}

TEST(AttitudeLaw, TurnsTheThrustTheShortestWayWhateverTheYawError) {
  controllers::AttitudeParams params;
  params.tilt_rate_limit_radps = 100.0;
  const Eigen::Quaterniond q_WB = quaternion_from_rpy({0.2, -0.1, 0.5});
  for (const double yaw : {0.5, 1.5, 3.0, -2.0}) {
    const Eigen::Quaterniond wanted = controllers::calc_wanted_attitude({-4, 6, 18}, yaw);
    const Eigen::Vector3d rates = controllers::calc_wanted_rates(q_WB, wanted, 0.0, params);
    // About the axis that is square to both thrusts, by the angle between them.
    const Eigen::Vector3d z = q_WB * kZ, z_wanted = wanted * kZ;
    const Eigen::Vector3d axis_B = q_WB.conjugate() * z.cross(z_wanted).normalized();
    const double angle = std::acos(z.dot(z_wanted));
    EXPECT_LT((rates.head<2>() - (params.tilt_p_per_s * angle * axis_B).head<2>()).norm(), 1e-9);
    EXPECT_NEAR(axis_B.z(), 0.0, 1e-12);
  }
}

TEST(AttitudeLaw, TurnsTheNoseTheShortWayWithinItsLimitAndFeedsTheYawRateForward) {
  const controllers::AttitudeParams params;
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  const auto yaw_rate = [&](double error, double reference) {
    return controllers::calc_wanted_rates(level, quaternion_from_rpy({0, 0, error}), reference,
                                          params)
        .z();
  };
  EXPECT_NEAR(yaw_rate(0.1, 0.0), params.yaw_p_per_s * 0.1, 1e-12);
  EXPECT_NEAR(yaw_rate(3.0, 0.0), params.yaw_rate_limit_radps, 1e-12);
  EXPECT_NEAR(yaw_rate(-3.0, 0.0), -params.yaw_rate_limit_radps, 1e-12);
  EXPECT_NEAR(yaw_rate(2 * kPi - 0.1, 0.0), -params.yaw_p_per_s * 0.1, 1e-9);
  EXPECT_NEAR(yaw_rate(0.0, 0.7), 0.7, 1e-12);
  // A tilted vehicle turns about the vertical: part of it is roll and pitch rate.
  const Eigen::Quaterniond tilted = quaternion_from_rpy({0.3, 0.2, 1.0});
  const Eigen::Vector3d rates = controllers::calc_wanted_rates(tilted, tilted, 0.7, params);
  EXPECT_LT((tilted * rates - 0.7 * kZ).norm(), 1e-9);
}

TEST(AttitudeLaw, RightsAVehicleThatHangsHeadDown) {
  const controllers::AttitudeParams params;
  const Eigen::Quaterniond down(0.0, 1.0, 0.0, 0.0);
  const Eigen::Vector3d rates =
      controllers::calc_wanted_rates(down, Eigen::Quaterniond::Identity(), 0.0, params);
  EXPECT_TRUE(rates.allFinite());
  EXPECT_NEAR(rates.head<2>().norm(), params.tilt_rate_limit_radps, 1e-9);
  EXPECT_EQ(controllers::calc_wanted_rates(down, down, 0.0, params), Eigen::Vector3d::Zero());
}

TEST(RateLaw, ScalesWithInertiaAndCancelsTheGyroscopicTorque) {
  const controllers::RotorcraftModel craft = make_craft();
  controllers::RateParams params;
  params.torque_limits_Nm.setConstant(1e3);
  controllers::RateLaw law(craft, params);
  const Eigen::Vector3d w(1, -2, 3), wanted(1.5, -2.5, 3.5), J = craft.inertia_kgm2;
  const Eigen::Vector3d torque = law.step(wanted, w, Eigen::Vector3d::Zero(), false);
  const Eigen::Vector3d alpha =
      (torque - w.cross(J.cwiseProduct(w))).cwiseQuotient(J);  // Euler's equation
  const double p = params.p_per_s.x() * 0.5, p_yaw = params.p_per_s.y() * 0.5;
  EXPECT_LT((alpha - Eigen::Vector3d(p, -p, p_yaw)).norm(), 1e-9);
}

TEST(RateLaw, DoesNotWindUpWhereTorqueIsLost) {
  const controllers::RotorcraftModel craft = make_craft();
  controllers::RateParams params;
  controllers::RateLaw law(craft, params);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  // Far beyond the own limits about x and z, within them about y.
  for (int i = 0; i < 100; ++i) law.step({100, 0.1, 100}, none, none, true);
  EXPECT_NEAR(law.integral_radps2().x(), params.period_s * params.i_per_s2.x() * 100, 1e-9)
      << "the first cycle does not know yet";
  EXPECT_NEAR(law.integral_radps2().y(), 100 * params.period_s * params.i_per_s2.x() * 0.1, 1e-9);
  law.reset();
  // What the mixer lost counts as well.
  for (int i = 0; i < 100; ++i) law.step({0.1, 0.1, 0.1}, none, {1.0, -1.0, 0.0}, true);
  EXPECT_EQ(law.integral_radps2().x(), 0.0);
  EXPECT_GT(law.integral_radps2().y(), 0.0);
  EXPECT_GT(law.integral_radps2().z(), 0.0);
}

// A tilted flight with a half turn of the nose: the vehicle must not wander.
TEST(QuadrotorPid, TurnsItsNoseInFullFlight) {
  QuadrotorSetup setup;
  setup.start.p = {0, 0, 2};
  const FlightPath straight = row_and_turn({0, 0, 2}, 0.0, 3.0, 1e9);
  setup.path = [straight](double time_s) {
    TrajectoryPoint at = straight(time_s);
    at.yaw_rad = time_s > 4.0 ? kPi - 0.01 : 0.0;  // at once
    return at;
  };
  QuadrotorLoop loop(setup);
  double off_m = 0.0;
  loop.run_until(12.0, [&] {
    const Eigen::Vector3d e = loop.sim().state().p_W - straight(loop.time_s()).p_W;
    if (loop.time_s() > 3.5) off_m = std::max(off_m, e.norm());
  });
  EXPECT_LT(off_m, 0.05);
  EXPECT_NEAR(loop.follower().heading_error_rad, 0.0, 0.01);
}

}  // namespace
}  // namespace vinerow::test::quadrotor_pid_test
