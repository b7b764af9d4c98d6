#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "controllers/parts/paths/path_pieces.h"
#include "controllers/path_follower/path_follower.h"
#include "controllers/path_follower/path_follower_law.h"
#include "controllers/path_follower/slip_estimate.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/mission.h"

namespace vinerow::controllers::path_follower_test {
namespace {

PathFollowerParams make_params() {
  PathFollowerParams params;
  params.lookahead_min_m = params.lookahead_max_m = 1.5;
  params.speed.acceleration_mps2 = 1e3;
  return params;
}

TEST(PathFollowerLaw, FollowsAnArcWithoutError) {
  PathFollowerParams params = make_params();
  params.speed.speed_mps = 1.0;
  PathFollowerLaw law(params);
  law.set_path(make_planned_path({{{{0, 0}, 0.0}, 15.0, 0.4, PathKind::kTurn, -1, 0.0}}, 0.33));
  Pose2 pose;
  for (int i = 0; i < 500; ++i) {
    const VelocityCommand command = law.step(pose);
    pose = advance(pose, command.v_mps * params.cycle_s, command.yaw_rate_radps * params.cycle_s);
    // Exact but for rounding: each cycle turns by the arc's own angle.
    ASSERT_NEAR((pose.p - Eigen::Vector2d(0, 2.5)).norm(), 2.5, 1e-9);
  }
}

TEST(PathFollowerLaw, ErrorsDieOutAsTheLinearModelSays) {
  // zeta = 1: e(s) = e0 (1 + s/L) exp(-s/L) on a straight, for errors small enough for sin(psi) =
  // psi.
  PathFollowerParams params = make_params();
  params.cycle_s = 0.001;
  PathFollowerLaw law(params);
  law.set_path(make_planned_path({make_straight({0, 0}, {30, 0}, PathKind::kLeg, 0, 0.0)}, 0.33));
  const double e0 = 0.01;
  Pose2 pose = {{0, e0}, 0.0};
  for (int i = 0; i < 5000; ++i) {
    const VelocityCommand command = law.step(pose);
    pose = advance(pose, command.v_mps * params.cycle_s, command.yaw_rate_radps * params.cycle_s);
    const double s = pose.p.x() / 1.5;
    // 1 % of e0: the cycle's delay of 2 mm over 1.5 m.
    ASSERT_NEAR(pose.p.y(), e0 * (1.0 + s) * std::exp(-s), 0.01 * e0);
  }
}

TEST(PathFollowerLaw, ComesBackFromFarOffAndFromBackwards) {
  for (const Pose2& start :
       {Pose2{{1, 4}, 0.0}, Pose2{{1, -4}, 0.5 * kPi}, Pose2{{1, 0}, kPi}, Pose2{{1, 2}, -3.0}}) {
    PathFollowerParams params = make_params();
    PathFollowerLaw law(params);
    law.set_path(make_planned_path({make_straight({0, 0}, {60, 0}, PathKind::kLeg, 0, 0.0)}, 0.33));
    Pose2 pose = start;
    int cycles = 0;
    for (; cycles < 6000 && !law.finished(); ++cycles) {
      const VelocityCommand command = law.step(pose);
      pose = advance(pose, command.v_mps * params.cycle_s, command.yaw_rate_radps * params.cycle_s);
    }
    EXPECT_TRUE(law.finished()) << start.p.transpose() << " " << start.yaw_rad;
    EXPECT_NEAR(pose.p.y(), 0.0, 1e-3);
    EXPECT_NEAR(pose.p.x(), 60.0, 0.1);
  }
}

TEST(PathFollower, RefusesLookaheadLimitsThatCross) {
  const VehicleDescription description = test::make_rover_description();
  ControllerContext context;
  context.part = "rover.controller";
  context.period = Duration{25'000'000};
  context.vehicle_description = &description;
  try {
    make_path_follower(test::make_parameters(path_follower_spec(), {{"lookahead_max_m", 0.5}}),
                       context);
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.controller (path_follower): lookahead_max_m = 0.5 m, must be >= "
                 "lookahead_min_m = 0.6 m");
  }
}

TEST(SpeedProfile, BrakesBeforeTurnsAndTheEnd) {
  const Path path(make_planned_path({make_straight({0, 0}, {20, 0}, PathKind::kLeg, 0, 0.0),
                                     {{{20, 0}, 0.0}, 4.0, 0.5, PathKind::kTurn, -1, 0.0}},
                                    0.33));
  SpeedLimits limits;
  limits.speed_mps = 2.0;
  limits.acceleration_mps2 = 0.5;
  limits.lateral_acceleration_mps2 = 0.5;
  limits.yaw_rate_radps = 10.0;
  limits.goal_speed_mps = 0.1;
  const SpeedProfile profile(path, limits);
  const auto speed_at = [&](double s) { return profile.speed_at(path, path.segment_at(s), s); };
  // In the turn sqrt(0.5 / 0.5) = 1; v^2 = 1 + 2 * 0.5 * distance before it, 2 at 3 m.
  EXPECT_DOUBLE_EQ(speed_at(5.0), 2.0);
  EXPECT_NEAR(speed_at(18.0), std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(speed_at(21.0), 1.0, 1e-9);
  EXPECT_NEAR(speed_at(23.5), std::sqrt(0.01 + 0.5), 1e-9);
  EXPECT_NEAR(speed_at(24.0), 0.1, 1e-9);
}

TEST(SpeedProfile, TakesTheSlowestOfPathAndLimits) {
  const Path path(
      make_planned_path({make_straight({0, 0}, {20, 0}, PathKind::kLeg, 0, 0.8)}, 0.33));
  EXPECT_DOUBLE_EQ(SpeedProfile(path, {}).speed_at(path, 3, 1.0), 0.8);
}

TEST(PathFollowerLaw, LeadsTheHeadingOfAVehicleThatSlides) {
  // The vehicle turns about a point 0.25 m ahead of its centre and crabs by 0.03 rad: its centre
  // moves along yaw + beta. With that side slip the law keeps the centre on the arc;
  // without it, the centre runs beside it.
  double error_m[2] = {};
  for (const bool compensated : {false, true}) {
    PathFollowerParams params = make_params();
    params.speed.speed_mps = 0.8;
    PathFollowerLaw law(params);
    law.set_path(make_planned_path({make_straight({0, 0}, {5, 0}, PathKind::kLeg, 0, 0.0),
                                    {{{5, 0}, 0.0}, 12.0, 0.4, PathKind::kTurn, -1, 0.0}},
                                   0.33));
    const Sideslip slide = {0.25, 0.03};
    Pose2 pose;
    for (int i = 0; i < 720; ++i) {
      const VelocityCommand c = law.step(pose, compensated ? slide : Sideslip{});
      const Eigen::Vector2d v_B(c.v_mps,
                                -slide.arm_m * c.yaw_rate_radps + slide.drift_rad * c.v_mps);
      pose.p += Eigen::Rotation2Dd(pose.yaw_rad) * v_B * params.cycle_s;
      pose.yaw_rad += c.yaw_rate_radps * params.cycle_s;
    }
    error_m[compensated] = std::abs(law.state().lateral_error_m);
  }
  EXPECT_GT(error_m[0], 0.05);
  EXPECT_LT(error_m[1], 0.01);
}

/// A vehicle that drives `share` of the yaw rate asked, one cycle late, and slides.
SlipEstimate learn(double share, const Sideslip& slide) {
  SlipEstimateParams params;
  params.learn_time_s = 1.0;
  SlipEstimate slip(params);
  double driven = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double requested = 0.8 * std::sin(0.005 * i);
    slip.update(requested, driven, {1.0, -slide.arm_m * driven + slide.drift_rad}, 0.025);
    driven = share * requested;
  }
  return slip;
}

TEST(SlipEstimate, LearnsShareArmAndDrift) {
  const SlipEstimate slip = learn(0.55, {0.2, 0.02});
  EXPECT_NEAR(slip.effectiveness(), 0.55, 0.03);
  EXPECT_NEAR(slip.slide().arm_m, 0.2, 0.02);
  EXPECT_NEAR(slip.slide().drift_rad, 0.02, 0.005);
}

TEST(SlipEstimate, StaysWhereNothingSlips) {
  const SlipEstimate slip = learn(1.0, {0.0, 0.0});
  EXPECT_NEAR(slip.effectiveness(), 1.0, 0.02);
  EXPECT_EQ(slip.slide().arm_m, 0.0);
  EXPECT_EQ(slip.slide().drift_rad, 0.0);
}

TEST(SlipEstimate, StaysWhenSwitchedOff) {
  SlipEstimateParams params;
  params.effectiveness = 0.4;
  params.learn_time_s = 0.0;
  SlipEstimate slip(params);
  for (int i = 0; i < 100; ++i) slip.update(0.8, 0.1, {1.0, 0.3}, 0.025);
  EXPECT_EQ(slip.effectiveness(), 0.4);
  EXPECT_EQ(slip.slide().arm_m, 0.0);
}

}  // namespace
}  // namespace vinerow::controllers::path_follower_test
