// Arcs, joints and vertical segments of a plan against plane geometry.

#include "controllers/trajectory/flight_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::test::flight_curve_test {
namespace {

using controllers::CurveRun;
using controllers::CurveSegment;

constexpr double kSharp_rad = 0.3;

PathPoint point_at(double x, double y, double z, double curvature_per_m = 0.0) {
  PathPoint point;
  point.p_W = {x, y, z};
  point.curvature_per_m = curvature_per_m;
  return point;
}

std::vector<CurveRun> runs_through(const std::vector<PathPoint>& points) {
  PlannedPath plan;
  plan.points = points;
  return controllers::make_curve_runs(plan, kSharp_rad);
}

TEST(FlightCurve, AClimbingArcIsAHelix) {
  // A quarter of a circle of 2 m about (-1, 0), to the left, 1.5 m up.
  for (const double side : {1.0, -1.0}) {
    const auto runs = runs_through({point_at(1, 0, 4, side * 0.5), point_at(-1, side * 2, 5.5)});
    ASSERT_EQ(runs.size(), 1u);
    ASSERT_EQ(runs[0].pieces.size(), 1u);
    const CurveSegment& arc = runs[0].pieces[0];
    EXPECT_NEAR(arc.plan_length_m, kPi, 1e-12);
    EXPECT_NEAR(arc.length_m, std::hypot(kPi, 1.5), 1e-12);
    EXPECT_NEAR(runs[0].length_m, arc.length_m, 1e-12);
    EXPECT_NEAR(arc.start.yaw_rad, side * 0.5 * kPi, 1e-12);
    EXPECT_NEAR(arc.end_yaw_rad(), side * kPi, 1e-12);
    for (const double share : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      const double turn_rad = share * 0.5 * kPi;
      const Eigen::Vector3d expected(-1.0 + 2.0 * std::cos(turn_rad),
                                     side * 2.0 * std::sin(turn_rad), 4.0 + 1.5 * share);
      EXPECT_NEAR((arc.at(share * arc.length_m) - expected).norm(), 0.0, 1e-12);
    }
  }
}

TEST(FlightCurve, AChordLongerThanTheDiameterIsStraight) {
  const auto runs = runs_through({point_at(0, 0, 1, 1.0), point_at(3, 0, 1)});
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].pieces[0].curvature_per_m, 0.0);
  EXPECT_EQ(runs[0].pieces[0].plan_length_m, 3.0);
  EXPECT_NEAR((runs[0].pieces[0].at(1.0) - Eigen::Vector3d(1, 0, 1)).norm(), 0.0, 1e-12);
}

TEST(FlightCurve, RunsEndAtCornersAndAtVerticals) {
  const double gentle_rad = kSharp_rad - 0.01, sharp_rad = kSharp_rad + 0.01;
  const auto on = [](const PathPoint& from, double length_m, double yaw_rad) {
    return point_at(from.p_W.x() + length_m * std::cos(yaw_rad),
                    from.p_W.y() + length_m * std::sin(yaw_rad), from.p_W.z());
  };
  std::vector<PathPoint> points = {point_at(0, 0, 0), point_at(0, 0, 2), point_at(0, 0, 3)};
  points.push_back(on(points.back(), 5.0, 0.0));
  points.push_back(points.back());  // twice the same place
  points.push_back(on(points.back(), 4.0, gentle_rad));
  points.push_back(on(points.back(), 7.0, gentle_rad - sharp_rad));
  const Eigen::Vector3d end = points.back().p_W;
  points.push_back(point_at(end.x(), end.y(), 1.0));
  points.push_back(point_at(end.x(), end.y(), 1.5));

  const std::vector<CurveRun> runs = runs_through(points);
  const std::vector<double> lengths_m = {3.0, 9.0, 7.0, 2.0, 0.5};  // up, two legs, leg, down, up
  const std::vector<std::size_t> pieces = {2, 2, 1, 1, 1};
  ASSERT_EQ(runs.size(), lengths_m.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    EXPECT_NEAR(runs[k].length_m, lengths_m[k], 1e-12) << k;
    EXPECT_EQ(runs[k].pieces.size(), pieces[k]) << k;
    EXPECT_EQ(runs[k].is_vertical, k != 1 && k != 2) << k;
  }
}

TEST(FlightCurve, ABendAcrossTheSouthIsSmall) {
  // Headings of 179 and -179 degrees differ by 2 degrees.
  const double off = std::tan(rad_from_deg(1.0));
  EXPECT_EQ(runs_through({point_at(0, 0, 1), point_at(-1, off, 1), point_at(-2, 0, 1)}).size(), 1u);
}

TEST(FlightCurve, ARiseOfMoreThanThreeTimesTheLengthIsVertical) {
  EXPECT_FALSE(runs_through({point_at(0, 0, 0), point_at(1, 0, 2.99)})[0].is_vertical);
  EXPECT_TRUE(runs_through({point_at(0, 0, 0), point_at(1, 0, -3.01)})[0].is_vertical);
}

TEST(FlightCurve, APlanWithoutLengthHasNoRun) {
  EXPECT_TRUE(runs_through({}).empty());
  EXPECT_TRUE(runs_through({point_at(1, 2, 3)}).empty());
  EXPECT_TRUE(runs_through({point_at(1, 2, 3), point_at(1, 2, 3)}).empty());
}

}  // namespace
}  // namespace vinerow::test::flight_curve_test
