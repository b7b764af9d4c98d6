// Time laws of straights, climbs and arcs against closed forms.

#include "controllers/trajectory/time_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/parts/paths/path_pieces.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::test::time_law_test {
namespace {

using controllers::CurveRun;
using controllers::SmoothRun;
using controllers::TimeLaw;
using controllers::TrajectoryLimits;

constexpr double kNever_m = 1e9;
constexpr double kReserve = 0.97;  // share of the accelerations that is used
constexpr double kArcRadius_m = 1.77;

/// From (0, 0, 1), as a leg.
CurveRun straight_to(const Eigen::Vector3d& end_W) {
  PlannedPath plan;
  plan.points.resize(2);
  plan.points[0].p_W = {0, 0, 1};
  plan.points[1].p_W = end_W;
  return controllers::make_curve_runs(plan, 0.3).front();
}

/// Three quarters of a circle to the left about (0, kArcRadius_m).
CurveRun left_arc() {
  const controllers::PathSegment arc{
      controllers::Pose2{}, 1.5 * kPi * kArcRadius_m, 1.0 / kArcRadius_m, PathKind::kLeg, 0, 0.0};
  return controllers::make_curve_runs(controllers::make_planned_path({arc}, 0.25), 0.3).front();
}

TEST(TimeLaw, AFlightOfYearsIsRefusedBeforeItIsSampled) {
  const controllers::SmoothRun run(left_arc(), 0.8);
  controllers::TrajectoryLimits limits;
  limits.lateral_acceleration_mps2 = 1e-308;
  try {
    const controllers::TimeLaw law(run, limits, 1e9);
    FAIL() << "not refused";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("at most 56 h are planned: raise its speeds"),
              std::string::npos)
        << error.what();
  }
}

TEST(TimeLaw, FliesAStraightAsFastAsItMay) {
  const controllers::SmoothRun run(straight_to({100, 0, 1}), 0.8);
  const controllers::TrajectoryLimits limits;
  const controllers::TimeLaw law(run, limits, 1e9);
  // v / a to speed up, the same to slow down, and what the easing adds.
  const double min_s = 100.0 / 3.0 + 3.0 / limits.acceleration_mps2;
  EXPECT_GT(law.duration_s(), min_s);
  EXPECT_LT(law.duration_s(), min_s + limits.ease_s + 0.3);
  EXPECT_NEAR(law.at(law.duration_s() / 2).value, 50.0, 0.05);
  EXPECT_NEAR(law.at(law.duration_s() / 2).first, 3.0, 1e-9);
  EXPECT_EQ(law.at(0.0).value, 0.0);
  EXPECT_NEAR(law.at(1e9).value, 100.0, 1e-9);
  EXPECT_NEAR(law.at(law.time_of(37.0)).value, 37.0, 1e-4);
  double before = 0.0;
  for (double t = 0.0; t < law.duration_s(); t += 0.01) {
    const auto at = law.at(t);
    ASSERT_GE(at.first, -1e-12);
    ASSERT_LE(std::abs(at.second), limits.acceleration_mps2);
    ASSERT_LT(std::abs(at.second - before), 0.01 * 2.2 / limits.ease_s);  // sets in over ease_s
    before = at.second;
  }
}

TEST(TimeLaw, AShortStraightIsATriangleOfSpeed) {
  constexpr double kLength_m = 4.0;
  const SmoothRun run(straight_to({kLength_m, 0, 1}), 0.8);
  const TrajectoryLimits limits;
  const TimeLaw law(run, limits, kNever_m);
  const double acceleration = kReserve * limits.acceleration_mps2;
  // v^2 = 2 a L / 2 at the top; the average over ease_s takes a ease_s / 4 off it.
  const double top_mps = std::sqrt(acceleration * kLength_m) - 0.25 * acceleration * limits.ease_s;
  EXPECT_NEAR(law.at(0.5 * law.duration_s()).first, top_mps, 0.01);
  // The average over ease_s of a t^2 / 2 is a (t^2 + ease_s^2 / 12) / 2: times of L / 4 and 3 L /
  // 4, which are symmetric about the top.
  const double middle_half_s = law.time_of(0.75 * kLength_m) - law.time_of(0.25 * kLength_m);
  const double first_quarter_s =
      std::sqrt(0.5 * kLength_m / acceleration - limits.ease_s * limits.ease_s / 12.0);
  EXPECT_NEAR(middle_half_s, 2.0 * (std::sqrt(kLength_m / acceleration) - first_quarter_s), 0.01);
}

TEST(TimeLaw, ClimbsAndSinksAtTheirSpeeds) {
  const TrajectoryLimits limits;
  for (const double rise_m : {30.0, -30.0}) {
    const SmoothRun run(straight_to({30, 0, 1 + rise_m}), 0.8);
    const TimeLaw law(run, limits, kNever_m);
    const double wanted_mps = rise_m > 0.0 ? limits.climb_speed_mps : -limits.descent_speed_mps;
    const auto middle = law.at(0.5 * law.duration_s());
    EXPECT_NEAR(middle.first * run.at(middle.value).first.z(), wanted_mps, 1e-6);
  }
}

TEST(TimeLaw, AnArcIsFlownAtItsLateralAcceleration) {
  const SmoothRun run(left_arc(), 0.8);
  const TrajectoryLimits limits;
  const TimeLaw law(run, limits, kNever_m);
  const auto middle = law.at(0.5 * law.duration_s());
  const SmoothRun::Sample on = run.at(middle.value);
  const double radius_m = (on.p_W.head<2>() - Eigen::Vector2d(0.0, kArcRadius_m)).norm();
  const double speed_mps = middle.first * on.first.norm();
  EXPECT_NEAR(speed_mps * speed_mps / radius_m, kReserve * limits.lateral_acceleration_mps2, 0.015);

  TrajectoryLimits slow_turn;
  slow_turn.yaw_rate_radps = 0.5;
  const TimeLaw turning(run, slow_turn, kNever_m);
  const auto half = turning.at(0.5 * turning.duration_s());
  EXPECT_NEAR(half.first * run.at(half.value).yaw_per_m, kReserve * 0.5, 0.005);
}

TEST(TimeLaw, TheLandingZoneIsFlownSlowly) {
  const SmoothRun run(straight_to({20, 0, 1}), 0.8);
  const TrajectoryLimits limits;
  const TimeLaw law(run, limits, 15.0);
  for (double at_m = 15.0; at_m < 20.0; at_m += 0.2) {
    EXPECT_LE(law.at(law.time_of(at_m)).first, limits.landing_speed_mps + 1e-9) << at_m;
  }
  EXPECT_NEAR(law.at(law.time_of(17.5)).first, limits.landing_speed_mps, 1e-6);
  EXPECT_GT(law.at(law.time_of(10.0)).first, 2.0);
}

}  // namespace
}  // namespace vinerow::test::time_law_test
