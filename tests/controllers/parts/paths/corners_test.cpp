// Followers of ground vehicles at the corners of a path of straights, and what they do when they
// have lost it.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "controllers/parts/paths/path_corners.h"
#include "controllers/parts/paths/path_pieces.h"
#include "controllers/parts/paths/path_watch.h"
#include "controllers/planning/routes/corner_rounding.h"
#include "engine/api/may_fail.h"
#include "engine/math/angles.h"
#include "engine/math/deviation.h"
#include "tests/controllers/support/mission.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::corners_test {
namespace {

using Vec = Eigen::Vector2d;

/// Two straights of 20 m; the second leaves the first by an angle, positive to the left.
std::vector<Vec> make_corner(double turn_rad, double leg_m = 20.0) {
  return {{0, 0}, {leg_m, 0}, Vec(leg_m, 0) + leg_m * controllers::direction(turn_rad)};
}

MissionSetup make_setup(const std::string& controller, const std::vector<Vec>& points) {
  MissionSetup setup;
  std::vector<double> x_m, y_m;
  for (const Vec& p : points) {
    x_m.push_back(p.x());
    y_m.push_back(p.y());
  }
  setup.start = {points.front(), 0.0};
  setup.planner = {"waypoints", {{"x_m", x_m}, {"y_m", y_m}}};
  setup.controller.type = controller;
  setup.longest_s = 400.0;
  return setup;
}

/// Largest distance of the way driven from the straights.
double largest_deviation(const MissionResult& result, const std::vector<Vec>& points) {
  const Polyline line(points);
  double largest_m = 0.0;
  for (const controllers::Pose2& pose : result.poses) {
    largest_m = std::max(largest_m, line.nearest(pose.p).distance_m);
  }
  return largest_m;
}

bool turns_on_the_spot(const std::string& controller) {
  return controller != "four_wheel_steering";
}

/// Least radius of the plan of a vehicle that steers by its axles, with the planner's reserve.
double planned_radius_m() {
  return 1.1 * *make_steered_description().min_turning_radius_m;
}

class EveryFollower : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryFollower, DrivesRoundCornersOfEveryAngle) {
  for (const double side : {1.0, -1.0}) {
    for (const double angle_deg : {45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0, 150.0, 180.0}) {
      const double turn_rad = rad_from_deg(angle_deg);
      const std::vector<Vec> points = make_corner(side * turn_rad);
      const MissionResult result = run_mission(make_setup(GetParam(), points));
      ASSERT_TRUE(result.finished) << side * angle_deg;
      EXPECT_LT((result.poses.back().p - points.back()).norm(), 0.15) << side * angle_deg;
      const double deviation_m = largest_deviation(result, points);
      if (turns_on_the_spot(GetParam())) {
        // The corner is reached to 0.1 m (pure_pursuit) or 0.05 m, and one cycle's way.
        EXPECT_LT(deviation_m, 0.15) << side * angle_deg;
        continue;
      }
      // An arc that touches both legs is R (1 - cos(turn / 2)) from them in its middle. A loop at
      // 180 deg: three circles of radius R, the middle one about a point on the leg's line.
      const double radius_m = planned_radius_m();
      constexpr double kTracking_m = 0.06;
      if (angle_deg <= 120.0) {
        const double expected_m = radius_m * (1.0 - std::cos(0.5 * turn_rad));
        EXPECT_NEAR(deviation_m, expected_m, kTracking_m) << side * angle_deg;
      } else if (angle_deg == 180.0) {
        EXPECT_NEAR(deviation_m, radius_m, kTracking_m);
      } else {
        EXPECT_LT(deviation_m, 2.0 * radius_m) << side * angle_deg;
      }
      EXPECT_LT(result.max_m, kTracking_m) << side * angle_deg;
    }
  }
}

TEST_P(EveryFollower, DrivesASquareAndThereAndBack) {
  const std::vector<std::vector<Vec>> paths = {{{0, 0}, {15, 0}, {15, 15}, {0, 15}, {0, 0}},
                                               {{0, 0}, {15, 0}, {5, 0}, {20, 0}},
                                               {{0, 0}, {12, 0}, {2, 8}, {12, 8}, {2, 16}}};
  for (const std::vector<Vec>& points : paths) {
    const MissionResult result = run_mission(make_setup(GetParam(), points));
    ASSERT_TRUE(result.finished);
    EXPECT_LT((result.poses.back().p - points.back()).norm(), 0.15);
    // Every waypoint is passed: exactly where it turns, else within the arc's distance of it.
    const double radius_m = planned_radius_m();
    for (std::size_t i = 1; i < points.size(); ++i) {
      double nearest_m = 1e9;
      for (const controllers::Pose2& pose : result.poses) {
        nearest_m = std::min(nearest_m, (pose.p - points[i]).norm());
      }
      EXPECT_LT(nearest_m, turns_on_the_spot(GetParam()) ? 0.15 : 1.5 * radius_m) << i;
    }
  }
}

/// It drives there, or has lost its path: it has never finished one without having driven it.
TEST_P(EveryFollower, DoesNotFinishAPathThatBeginsElsewhere) {
  // A metre far away, and a way that comes by.
  const std::vector<std::vector<Vec>> paths = {{{24, 3}, {23, 3}}, {{24, 3}, {-1, 0}}};
  for (const std::vector<Vec>& points : paths) {
    MissionSetup setup = make_setup(GetParam(), points);
    setup.start = {Vec::Zero(), 0.0};
    const MissionResult result = run_mission(setup);
    double driven_m = 0.0;
    for (std::size_t i = 1; i < result.poses.size(); ++i) {
      driven_m += (result.poses[i].p - result.poses[i - 1].p).norm();
    }
    if (result.finished) {
      EXPECT_GT(driven_m, 20.0);
    }
    EXPECT_EQ(result.finished, GetParam() == "pure_pursuit");
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, EveryFollower,
                         ::testing::Values("path_follower", "pure_pursuit", "four_wheel_steering"),
                         [](const auto& each) { return each.param; });

TEST(PathCorners, FindsJumpsOfDirectionAndNoArcs) {
  // Straight, half a circle in two chords, straight: no corner, though the chords bend by 45 deg.
  const controllers::Pose2 begin{{10, 0}, 0.0};
  const controllers::PathSegment arc{begin, 2.0 * kPi, 0.5, PathKind::kTurn, -1, 0.0};
  const PlannedPath smooth = controllers::make_planned_path(
      {controllers::make_straight({0, 0}, {10, 0}, PathKind::kLeg, 0, 0.0), arc,
       controllers::make_straight({10, 4}, {0, 4}, PathKind::kLeg, 1, 0.0)},
      3.5);
  EXPECT_TRUE(controllers::find_corners(smooth, 1e-6).empty());
  PlannedPath bent;
  for (const Vec& p : {Vec(0, 0), Vec(5, 0), Vec(5, 0), Vec(5, 5), Vec(0, 5), Vec(10, 5)}) {
    PathPoint point;
    point.p_W << p, 0.0;
    bent.points.push_back(point);  // yaw_rad is not set: the chords count
  }
  const std::vector<controllers::PathCorner> corners =
      controllers::find_corners(bent, controllers::kSharpCorner_rad);
  ASSERT_EQ(corners.size(), 3u);
  EXPECT_EQ(corners[0].point, 2);
  EXPECT_NEAR(corners[0].turn_rad, 0.5 * kPi, 1e-12);
  EXPECT_NEAR(std::abs(corners[2].turn_rad), kPi, 1e-12);
}

TEST(CornerRounding, TouchesBothLegsAndKeepsTheRadius) {
  for (const double angle_deg : {10.0, 45.0, 90.0, 119.0, -60.0, 150.0, 180.0}) {
    const double turn_rad = rad_from_deg(angle_deg);
    const controllers::RoundedPath rounded =
        controllers::round_corners(make_corner(turn_rad), {1.0, 0.5}, 2.0, PathKind::kLeg);
    double length_m = 0.0;
    for (std::size_t i = 0; i < rounded.pieces.size(); ++i) {
      EXPECT_LE(std::abs(rounded.pieces[i].curvature_per_m), 0.5 + 1e-12);
      length_m += rounded.pieces[i].length_m;
      if (i == 0) continue;
      const controllers::Pose2 end = rounded.pieces[i - 1].end(), next = rounded.pieces[i].start;
      EXPECT_LT((end.p - next.p).norm(), 1e-9) << angle_deg;
      EXPECT_LT(std::abs(wrap_angle(end.yaw_rad - next.yaw_rad)), 1e-9) << angle_deg;
    }
    EXPECT_EQ(rounded.arcs, std::abs(angle_deg) <= 120.0 ? 1 : 0);
    EXPECT_EQ(rounded.loops, std::abs(angle_deg) <= 120.0 ? 0 : 1);
    if (rounded.arcs == 1) {
      const double half_rad = 0.5 * std::abs(turn_rad);
      EXPECT_NEAR(length_m, 40.0 - 4.0 * std::tan(half_rad) + 4.0 * half_rad, 1e-9);
    }
  }
  // A slight kink between legs too short for its arc stays; a sharp one becomes a loop.
  EXPECT_EQ(controllers::round_corners(make_corner(0.4, 0.2), {1.0, 1.0}, 2.0, PathKind::kLeg)
                .pieces.size(),
            2u);
  EXPECT_EQ(
      controllers::round_corners(make_corner(1.5, 0.5), {1.0, 1.0}, 2.0, PathKind::kLeg).loops, 1);
}

controllers::PathWatch::Cycle at(double x_m, double y_m, double distance_m, double travel_m) {
  return {{x_m, y_m}, {x_m, 0.0}, distance_m, 100.0, travel_m};
}

TEST(PathWatch, TellsWhoGoesAwayAndWhoDoesNotGetOn) {
  controllers::PathWatch away({5.0});
  // From 20 m off it may come back, and be no more than 5 m farther than it was.
  for (double y = 20.0; y > 0.0; y -= 0.1) away.update(at(0.0, y, 0.0, 0.1));
  EXPECT_FALSE(away.is_lost());
  for (double y = 0.0; y < 5.0; y += 0.1) away.update(at(30.0, y, 30.0, 0.1));
  EXPECT_FALSE(away.is_lost());
  { away.update(at(30.0, 5.2, 30.0, 0.1)); }
  EXPECT_EQ(away.failure(),
            "lost its path: 5.2 m away from it at (30.00, 5.20), 30.0 m along its path of 100.0 m");

  controllers::PathWatch circling({5.0});
  for (int i = 0; i < 500; ++i) circling.update(at(10.0, 1.0, 10.0, 0.1));
  EXPECT_FALSE(circling.is_lost());  // 10 times 5 m and three times the 1 m beside
  for (int i = 0; i < 40; ++i) circling.update(at(10.0, 1.0, 10.0, 0.1));
  EXPECT_EQ(circling.failure(),
            "lost its path: its wheels were commanded to roll 53 m without progress at (10.00, "
            "1.00), 10.0 m along "
            "its path of 100.0 m");

  // A path that begins far away must not pass by a vehicle that stands.
  controllers::PathWatch passing({5.0});
  for (int i = 0; i <= 100; ++i) passing.update(at(10.0, 1.0, 0.1 * i, 0.0));
  EXPECT_FALSE(passing.is_lost());
  { passing.update(at(10.0, 1.0, 10.1, 0.0)); }
  EXPECT_EQ(passing.failure(),
            "lost its path: 10.1 m of it passed by while the vehicle moved by 0.0 m at (10.00, "
            "1.00), 10.1 m along its path of 100.0 m; a path begins where the vehicle is");
  // A third of the path's length is enough, by the wheels or by the estimate.
  for (const double travel_m : {0.0, 0.1}) {
    controllers::PathWatch inside({5.0});
    for (int i = 0; i <= 300; ++i) {
      inside.update(at(travel_m > 0.0 ? 0.0 : 0.1 * i, 1.0, 0.3 * i, travel_m));
    }
    EXPECT_FALSE(inside.is_lost()) << inside.failure();
  }
  controllers::PathWatch beside({5.0});
  controllers::PathWatch::Cycle end = at(10.0, 20.0, 100.0, 0.0);
  end.is_finished = true;
  beside.update(end);
  EXPECT_EQ(beside.failure(),
            "lost its path: 20.0 m away from its end at (10.00, 20.00), 100.0 m along its path of "
            "100.0 m");

  // A stationary vehicle is never lost.
  controllers::PathWatch stationary({5.0});
  const AllocationCounter allocations;
  for (int i = 0; i < 100000; ++i) stationary.update(at(10.0, 1.0, 10.0, 0.0));
  EXPECT_EQ(allocations.count(), 0u);
  EXPECT_FALSE(stationary.is_lost());
}

}  // namespace
}  // namespace vinerow::test::corners_test
