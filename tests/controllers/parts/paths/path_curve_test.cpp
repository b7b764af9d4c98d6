#include "controllers/parts/paths/path_curve.h"

#include <gtest/gtest.h>

#include "controllers/parts/paths/path_pieces.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers::path_test {
namespace {

/// 10 m east, a left semicircle of radius 2, 10 m west.
std::vector<PathSegment> make_u_turn() {
  return {make_straight({0, 0}, {10, 0}, PathKind::kLeg, 0, 0.0),
          {{{10, 0}, 0.0}, 2.0 * kPi, 0.5, PathKind::kTurn, -1, 0.7},
          make_straight({10, 4}, {0, 4}, PathKind::kLeg, 1, 0.0)};
}

TEST(PathSegments, SplitsEachPieceIntoRoundLengthOverPitch) {
  const PlannedPath plan = make_planned_path(make_u_turn(), 0.33);
  // round(10 / 0.33) = 30, round(6.283 / 0.33) = 19, and the last point.
  EXPECT_EQ(plan.points.size(), 30u + 19u + 30u + 1u);
  EXPECT_NEAR(plan.length_m, 20.0 + 2.0 * kPi, 1e-12);
  EXPECT_EQ(plan.points[30].p_W.head<2>(), Eigen::Vector2d(10, 0));
  EXPECT_EQ(plan.points[30].kind, PathKind::kTurn);
  EXPECT_EQ(plan.points[30].alley, -1);
  EXPECT_EQ(plan.points[49].p_W.head<2>(), Eigen::Vector2d(10, 4));
  EXPECT_EQ(plan.points[49].alley, 1);
  EXPECT_NEAR((plan.points.back().p_W - Eigen::Vector3d(0, 4, 0)).norm(), 0.0, 1e-12);
}

TEST(PathSegments, APlanOfMillionsOfPointsIsRefused) {
  try {
    make_planned_path(make_u_turn(), 1e-6);
    FAIL() << "not refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "a plan of 0.02628 km with a point every 1e-06 m has 26.3 million points, must be "
                 "at most 2 million: take a coarser waypoint_pitch_m");
  }
}

TEST(Path, KnowsTheExactCurveBetweenItsPoints) {
  for (const double pitch : {0.33, 2.0}) {
    const Path path(make_planned_path(make_u_turn(), pitch));
    EXPECT_NEAR(path.length_m(), 20.0 + 2.0 * kPi, 1e-9);
    // A third round the turn.
    const Pose2 pose = path.pose_at(10.0 + 2.0 * kPi / 3.0);
    EXPECT_NEAR(pose.p.x(), 10.0 + 2.0 * std::sin(kPi / 3.0), 1e-9);
    EXPECT_NEAR(pose.p.y(), 2.0 - 2.0 * std::cos(kPi / 3.0), 1e-9);
    EXPECT_NEAR(wrap_angle(pose.yaw_rad - kPi / 3.0), 0.0, 1e-9);
    EXPECT_DOUBLE_EQ(path.curvature_at(11.0), 0.5);
    EXPECT_DOUBLE_EQ(path.curvature_at(5.0), 0.0);
    EXPECT_DOUBLE_EQ(path.curvature_at(99.0), 0.0);
  }
}

TEST(Path, LateralErrorIsFromTheArcAndPositiveToTheLeft) {
  const Path path(make_planned_path(make_u_turn(), 1.0));
  const Eigen::Vector2d centre(10, 2);
  for (const double radius : {1.5, 2.0, 2.75}) {
    for (const double angle : {-1.3, -0.4, 0.0, 0.9, 1.4}) {
      const auto nearest = path.nearest(centre + radius * direction(angle), 5.0, 25.0);
      EXPECT_NEAR(nearest.lateral_error_m, 2.0 - radius, 1e-9);
      EXPECT_NEAR(nearest.distance_m, 10.0 + 2.0 * (angle + 0.5 * kPi), 1e-9);
      EXPECT_NEAR(wrap_angle(nearest.yaw_rad - angle - 0.5 * kPi), 0.0, 1e-9);
    }
  }
}

TEST(Path, StaysInItsWindow) {
  const Path path(make_planned_path(make_u_turn(), 0.5));
  // A point on the way back, looked for on the way out.
  const auto nearest = path.nearest({5.0, 3.9}, 0.0, 8.0);
  EXPECT_NEAR(nearest.distance_m, 5.0, 1e-9);
  EXPECT_NEAR(nearest.lateral_error_m, 3.9, 1e-9);
}

TEST(Path, SumsTheTurnOverAStretch) {
  const Path path(make_planned_path(make_u_turn(), 0.4));
  EXPECT_NEAR(path.turn_between_rad(9.0, 11.0), 0.5, 1e-9);
  EXPECT_NEAR(path.turn_between_rad(0.0, 99.0), kPi, 1e-9);
}

TEST(Path, TakesPlansWithoutLength) {
  EXPECT_TRUE(Path(PlannedPath{}).empty());
  PlannedPath one;
  one.points.resize(1);
  EXPECT_TRUE(Path(one).empty());
  one.points.resize(3);
  EXPECT_TRUE(Path(one).empty());
}

}  // namespace
}  // namespace vinerow::controllers::path_test
