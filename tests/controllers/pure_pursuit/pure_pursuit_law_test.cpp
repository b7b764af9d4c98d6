#include "controllers/pure_pursuit/pure_pursuit_law.h"

#include <gtest/gtest.h>

#include "controllers/parts/paths/path_pieces.h"
#include "engine/math/angles.h"

namespace vinerow::controllers::pure_pursuit_law_test {
namespace {

PlannedPath make_straight_plan(double length_m = 10.0, double pitch_m = 1.0) {
  return make_planned_path({make_straight({0, 0}, {length_m, 0}, PathKind::kLeg, 0, 0.0)}, pitch_m);
}

TEST(IntersectCircle, HasTheFourCasesOfFigureTen) {
  EXPECT_FALSE(intersect_circle({0, 2}, 1.0, {-5, 0}, {5, 0}));            // a: misses the line
  EXPECT_FALSE(intersect_circle({0, 0}, 1.0, {2, 0}, {5, 0}));             // b: meets it outside
  EXPECT_DOUBLE_EQ(*intersect_circle({0, 0}, 1.0, {0, 0}, {4, 0}), 0.25);  // c: once
  EXPECT_DOUBLE_EQ(*intersect_circle({2, 0}, 1.0, {0, 0}, {4, 0}),
                   0.75);                                       // d: twice, nearer the end
  EXPECT_FALSE(intersect_circle({0, 0}, 1.0, {1, 0}, {1, 0}));  // no segment at all
}

TEST(PurePursuitLaw, AimsAtTheLookaheadPointAndSlowsByEquationSeven) {
  PurePursuitParams params;
  params.lookahead_m = params.crossed_distance_m = 1.25;
  params.yaw_rate_limit_radps = 100.0;
  PurePursuitLaw law(params);
  law.set_path(make_straight_plan());
  // 0.75 m beside the path: the circle meets it 1 m ahead, 36.87 deg to the right.
  const VelocityCommand command = law.step({{0.0, 0.75}, 0.0});
  const double theta = -std::atan2(0.75, 1.0);
  EXPECT_NEAR(law.local_goal().x(), 1.0, 1e-12);
  EXPECT_NEAR(command.yaw_rate_radps, theta / params.cycle_s, 1e-9);
  EXPECT_NEAR(command.v_mps, params.speed_mps * (1.0 - std::abs(theta) / (2.0 * kPi)), 1e-12);
}

TEST(PurePursuitLaw, TurnsOnTheSpotBeyondTheLargestAngleOfEquationSeven) {
  PurePursuitParams params;
  params.largest_angle_rad = rad_from_deg(30.0);
  PurePursuitLaw law(params);
  law.set_path(make_straight_plan());
  // The goal is 60 deg to the left: the equation's speed is -v_t.
  const VelocityCommand command = law.step({{0.0, 0.0}, rad_from_deg(-60.0)});
  EXPECT_EQ(command.v_mps, 0.0);
  EXPECT_GT(command.yaw_rate_radps, 0.0);
}

TEST(PurePursuitLaw, LimitsTheYawRateAndWrapsTheAngle) {
  PurePursuitLaw law(PurePursuitParams{});
  law.set_path(make_straight_plan());
  // Heading almost backwards, from either side: the short way round, at the limit.
  EXPECT_DOUBLE_EQ(law.step({{0, 0}, 3.0}).yaw_rate_radps, -7.0 / 3.6);
  EXPECT_DOUBLE_EQ(law.step({{0, 0}, -3.0}).yaw_rate_radps, 7.0 / 3.6);
}

TEST(PurePursuitLaw, ThresholdLeavesSmallAnglesAlone) {
  PurePursuitParams params;
  params.steering_threshold_rad = rad_from_deg(2.5);
  PurePursuitLaw law(params);
  law.set_path(make_straight_plan());
  EXPECT_EQ(law.step({{0, 0}, rad_from_deg(2.4)}).yaw_rate_radps, 0.0);
  EXPECT_NE(law.step({{0, 0}, rad_from_deg(2.6)}).yaw_rate_radps, 0.0);
}

TEST(PurePursuitLaw, GoesBackToTheLastWaypointWhenThePathIsOutOfReach) {
  PurePursuitLaw law(PurePursuitParams{});
  law.set_path(make_straight_plan());
  law.step({{0.5, 0.0}, 0.0});
  EXPECT_EQ(law.index(), 1);
  law.step({{0.5, 5.0}, 0.0});
  EXPECT_EQ(law.local_goal(), law.points()[law.index()]);
}

TEST(PurePursuitLaw, TakesTheFirstSegmentWhereSeveralMeetTheCircle) {
  // A hairpin of 0.4 m: from the way out the circle meets both ways; the way out is meant (figure
  // 11).
  PurePursuitLaw law(PurePursuitParams{});
  law.set_path(make_planned_path({make_straight({0, 0}, {10, 0}, PathKind::kLeg, 0, 0.0),
                                  make_straight({10, 0}, {10, 0.4}, PathKind::kTurn, -1, 0.0),
                                  make_straight({10, 0.4}, {0, 0.4}, PathKind::kLeg, 1, 0.0)},
                                 0.33));
  law.step({{0.0, 0.0}, 0.0});
  EXPECT_NEAR(law.local_goal().y(), 0.0, 1e-12);
  EXPECT_NEAR(law.local_goal().x(), 0.75, 1e-12);
}

TEST(PurePursuitLaw, DoesNotEndWhereAPathStartsAtItsGoal) {
  PurePursuitLaw law(PurePursuitParams{});
  law.set_path(make_planned_path(
      {{{{0, 0}, 0.0}, 2.0 * kPi * 3.0, 1.0 / 3.0, PathKind::kLeg, 0, 0.0}}, 0.33));
  law.step({{0, 0}, 0.0});
  EXPECT_FALSE(law.finished());
}

}  // namespace
}  // namespace vinerow::controllers::pure_pursuit_law_test
