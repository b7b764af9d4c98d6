// Guidance `waypoint_guidance` along legs, flown by a point that turns like an aircraft.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/math/angles.h"
#include "tests/controllers/waypoint_guidance/air_bench.h"

namespace vinerow::test::air_course_test {
namespace {

const Values kStop = {{"end", std::string("stop")}};

Values with(Values values, const std::string& name, const ParameterSet::Value& value) {
  values.emplace_back(name, value);
  return values;
}

struct Course {
  double time_s = 0.0;
  double straight_rms_m = 0.0;  ///< cross track in phase kStraight
  double straight_max_m = 0.0;
  double inner_rms_m = 0.0;  ///< on lanes, 40 m and more from their ends
  double inner_max_m = 0.0;
  double turned_rad = 0.0;     ///< sum of |heading changes| of the vehicle
  std::vector<int> waypoints;  ///< in the order in which they were flown to
  std::vector<Eigen::Vector2d> track;
  std::vector<double> cross_m;  ///< in phase kStraight
  bool ended = false;
};

Course fly(const PlannedPath& plan, const Values& values, PlaneOptions options,
           double longest_s = 600.0) {
  AirBench bench(values, options);
  bench.give_plan(plan);
  Course course;
  double square = 0.0, inner = 0.0, yaw_rad = options.yaw_rad;
  int inner_count = 0;
  bench.fly(longest_s, [&](double, const Odometry& seen, const AirReference& reference) {
    const Eigen::Vector2d p = seen.X_WB.p.head<2>();
    course.track.push_back(p);
    const double now_rad = yaw_from_quaternion(seen.X_WB.q);
    course.turned_rad += std::abs(wrap_angle(now_rad - yaw_rad));
    yaw_rad = now_rad;
    if (course.waypoints.empty() || course.waypoints.back() != reference.waypoint) {
      course.waypoints.push_back(reference.waypoint);
    }
    course.ended = reference.phase == AirPhase::kDone;
    if (reference.phase != AirPhase::kStraight) return;
    const double off_m = std::abs(reference.cross_track_m);
    course.cross_m.push_back(reference.cross_track_m);
    square += off_m * off_m;
    course.straight_max_m = std::max(course.straight_max_m, off_m);
    const auto to = static_cast<std::size_t>(reference.waypoint);
    const Eigen::Vector2d a = plan.points[to - 1].p_W.head<2>(), b = plan.points[to].p_W.head<2>();
    const double s = (b - a).normalized().dot(p - a);
    if (s < 40.0 || s > (b - a).norm() - 40.0) return;
    inner += off_m * off_m;
    course.inner_max_m = std::max(course.inner_max_m, off_m);
    ++inner_count;
  });
  course.time_s = bench.time_s();
  course.straight_rms_m = std::sqrt(square / static_cast<double>(course.cross_m.size()));
  course.inner_rms_m = std::sqrt(inner / inner_count);
  return course;
}

PlaneOptions in_the_air(double yaw_rad, Eigen::Vector2d wind = Eigen::Vector2d::Zero()) {
  PlaneOptions options;
  options.start_W = {0, 0, 100};
  options.yaw_rad = yaw_rad;
  options.wind = wind;
  return options;
}

std::vector<int> numbers_to(int last) {
  std::vector<int> numbers;
  for (int i = 1; i <= last; ++i) numbers.push_back(i);
  return numbers;
}

TEST(AirCourse, SquareInStillAir) {
  const PlannedPath plan =
      make_waypoints({{0, 0, 100}, {200, 0, 100}, {200, 200, 100}, {0, 200, 100}, {0, 0, 100}});
  const Course course = fly(plan, kStop, in_the_air(0.0));
  EXPECT_TRUE(course.ended);
  EXPECT_EQ(course.waypoints, numbers_to(4));
  EXPECT_LT(course.straight_rms_m, 0.3);
  EXPECT_LT(course.straight_max_m, 1.0);
  // Three corners of 90 deg, and a little settling after each.
  EXPECT_NEAR(course.turned_rad, 1.5 * kPi, 3.0 * rad_from_deg(30.0));
  // No leg is passed by more than a metre in the turn onto it.
  for (const Eigen::Vector2d& p : course.track) {
    ASSERT_LT(p.x(), 201.0);
    ASSERT_LT(p.y(), 201.0);
    ASSERT_GT(p.x(), -1.0);
    ASSERT_GT(p.y(), -1.0);
  }
}

TEST(AirCourse, LanesOfTheReferenceInStillAir) {
  // 10 lanes of 260 m, 45 m apart, at 12 m/s: two corners of 90 deg make a U-turn.
  const Course course = fly(make_lanes(10, 260, 45, 100), kStop, in_the_air(0.5 * kPi));
  EXPECT_TRUE(course.ended);
  EXPECT_EQ(course.waypoints, numbers_to(19));
  EXPECT_LT(course.straight_rms_m, 0.25);
  EXPECT_LT(course.straight_max_m, 0.8);
  EXPECT_NEAR(course.turned_rad, 9.0 * kPi, 9.0 * rad_from_deg(30.0));
}

TEST(AirCourse, LanesInMeanWind) {
  for (const Eigen::Vector2d& wind :
       {Eigen::Vector2d(5, 0), Eigen::Vector2d(0, 5), Eigen::Vector2d(-4, -3)}) {
    // A turn with the wind takes the way that the wind blows meanwhile.
    const Course course = fly(make_lanes(5, 300, 85, 100), kStop, in_the_air(0.5 * kPi, wind));
    EXPECT_TRUE(course.ended);
    EXPECT_EQ(course.waypoints, numbers_to(9));
    EXPECT_LT(course.inner_rms_m, 0.3) << wind.transpose();
    EXPECT_LT(course.inner_max_m, 1.5) << wind.transpose();
    EXPECT_LT(course.straight_max_m, 4.0) << wind.transpose();
  }
}

TEST(AirCourse, LanesThatAreTooNearAreOvershotAndFoundAgain) {
  const Course course = fly(make_lanes(6, 300, 25, 100), kStop, in_the_air(0.5 * kPi));
  EXPECT_TRUE(course.ended);
  EXPECT_EQ(course.waypoints.back(), 11);
  EXPECT_LT(course.straight_max_m, 2.0 * 21.0);
  EXPECT_LT(course.turned_rad, 5.0 * rad_from_deg(330.0));
}

TEST(AirCourse, TurnsBackOnTheSameLine) {
  const Course course =
      fly(make_waypoints({{0, 0, 100}, {200, 0, 100}, {-200, 0.5, 100}}), kStop, in_the_air(0.0));
  EXPECT_TRUE(course.ended);
  // Two more half turns lead back onto the line.
  EXPECT_LT(course.turned_rad, rad_from_deg(360.0));
  EXPECT_LT(std::abs(course.cross_m.back()), 0.1);
}

TEST(AirCourse, WaypointsTooNearDoNotMakeItCircle) {
  const Course course = fly(make_waypoints({{0, 0, 100},
                                            {100, 0, 100},
                                            {105, 5, 100},
                                            {100, 12, 100},
                                            {110, 20, 100},
                                            {300, 20, 100}}),
                            kStop, in_the_air(0.0));
  EXPECT_TRUE(course.ended);
  EXPECT_EQ(course.waypoints.back(), 5);
  EXPECT_LT(course.time_s, 45.0);
  EXPECT_LT(std::abs(course.cross_m.back()), 0.5);
}

TEST(AirCourse, MirroredPlanGivesMirroredTrack) {
  PlannedPath plan = make_lanes(4, 220, 50, 100, 0.4);
  const Course there = fly(plan, kStop, in_the_air(0.5 * kPi + 0.4, {2, 1}));
  for (PathPoint& point : plan.points) point.p_W.y() *= -1.0;
  const Course mirrored = fly(plan, kStop, in_the_air(-0.5 * kPi - 0.4, {2, -1}));
  ASSERT_EQ(there.track.size(), mirrored.track.size());
  for (std::size_t i = 0; i < there.track.size(); ++i) {
    ASSERT_NEAR(there.track[i].x(), mirrored.track[i].x(), 1e-6) << i;
    ASSERT_NEAR(there.track[i].y(), -mirrored.track[i].y(), 1e-6) << i;
  }
}

TEST(AirCourse, PaperLawSwingsButStaysBounded) {
  PlaneOptions displaced = in_the_air(0.0);
  displaced.start_W.y() = 10.0;
  const PlannedPath plan = make_waypoints({{0, 0, 100}, {600, 0, 100}});
  const Course smooth = fly(plan, kStop, displaced);
  const Course paper = fly(plan, with(kStop, "law", std::string("paper")), displaced);
  EXPECT_LT(std::abs(smooth.cross_m.back()), 0.01);
  EXPECT_TRUE(paper.ended);
  EXPECT_LE(paper.straight_max_m, 10.0 + 1e-9);
  // It heads for the next waypoint, 600 m away, until within the tolerance of 4 m that shrinks to
  // 1 m, and then no longer towards the line: late and with an offset.
  double within_s = 0.0, paper_within_s = 0.0;
  for (const double e : smooth.cross_m) within_s += std::abs(e) > 1.0 ? 0.05 : 0.0;
  for (const double e : paper.cross_m) paper_within_s += std::abs(e) > 1.0 ? 0.05 : 0.0;
  EXPECT_GT(paper_within_s, 4.0 * within_s);
  const Course lanes = fly(make_lanes(6, 260, 45, 100), with(kStop, "law", std::string("paper")),
                           in_the_air(0.5 * kPi));
  EXPECT_TRUE(lanes.ended);
  EXPECT_EQ(lanes.waypoints, numbers_to(11));
  EXPECT_LT(lanes.straight_max_m, 5.0);
  const Course smooth_lanes = fly(make_lanes(6, 260, 45, 100), kStop, in_the_air(0.5 * kPi));
  EXPECT_GT(lanes.straight_rms_m, 2.0 * smooth_lanes.straight_rms_m);
}

TEST(AirCourse, WindThatNobodyTellsOfShiftsTheTrackByAKnownLength) {
  // The heading is then taken for the course: at rest chi - atan(e / length) is the crab angle.
  PlaneOptions options = in_the_air(0.0, {0, 3});
  options.has_air_data = false;
  const Course course = fly(make_waypoints({{0, 0, 100}, {600, 0, 100}}), kStop, options);
  EXPECT_NEAR(course.cross_m.back(), 15.0 * std::tan(std::asin(3.0 / 12.0)), 0.05);
  options.has_air_data = true;
  const Course informed = fly(make_waypoints({{0, 0, 100}, {600, 0, 100}}), kStop, options);
  EXPECT_NEAR(informed.cross_m.back(), 0.0, 0.01);
}

TEST(AirCourse, TurnByFormulaBeginsWhereTheFormulaSays) {
  const PlannedPath plan = make_waypoints({{0, 0, 100}, {300, 0, 100}, {300, 300, 100}});
  for (const char* start : {"formula", "predicted"}) {
    Values values = with(kStop, "turn_start", std::string(start));
    values = with(with(values, "bank_lag_s", 0.45), "yaw_lag_s", 0.0);  // as in the reference
    AirBench bench(values, in_the_air(0.0));
    bench.give_plan(plan);
    double began_m = 0.0;
    bench.fly(60.0, [&](double, const Odometry& seen, const AirReference& reference) {
      if (reference.phase == AirPhase::kTurn && began_m == 0.0) began_m = seen.X_WB.p.x();
    });
    // R tan(45 deg) + V (phi / (2 rate) + lag) = 20.97 + 8.9 m before the corner; rolling out
    // takes a little more than that.
    const double formula_m = 300.0 - 29.87;
    EXPECT_NEAR(began_m, formula_m, std::string(start) == "formula" ? 0.61 : 4.0) << start;
  }
}

TEST(AirCourse, TooStrongWindIsToldOnceAndHeldAgainst) {
  AirBench bench(kStop, in_the_air(0.5 * kPi, {13, 0}));
  bench.give_plan(make_waypoints({{0, 0, 100}, {0, 300, 100}}));
  AirReference last;
  bench.fly(30.0, [&](double, const Odometry&, const AirReference& now) { last = now; });
  EXPECT_TRUE(bench.has_event("wind of 13.0 m/s: no heading holds bearing "));
  EXPECT_EQ(bench.events().size(), 2u);
  EXPECT_DOUBLE_EQ(last.airspeed_mps, 12.0);
  // West, or between west and the line to the north: never downwind.
  EXPECT_LT(std::cos(last.heading_rad), 0.0);
}

}  // namespace
}  // namespace vinerow::test::air_course_test
