// Guidance `dwa` in closed loop with exact kinematics.

#include "controllers/dwa/dwa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/dwa/course.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::dwa_test {
namespace {

int count_events(const Drive& drive, const std::string& part) {
  int count = 0;
  for (const Event& event : drive.events) count += event.text.find(part) != std::string::npos;
  return count;
}

std::string all_events(const Drive& drive) {
  std::string text;
  for (const Event& event : drive.events) text += event.text + "\n";
  return text;
}

TEST(Dwa, FollowsAllTheWayInAFreeAlley) {
  for (const double canopy_half_m : {0.3, 0.35, 0.4}) {
    Course course = make_alley(canopy_half_m);
    course.range_noise_m = 0.003;
    const Drive result = drive(course);
    EXPECT_TRUE(result.finished);
    EXPECT_EQ(result.drive_ticks + result.stop_ticks, 0);
    EXPECT_TRUE(result.events.empty()) << all_events(result);
  }
}

TEST(Dwa, PassesABoxAtTheSide) {
  for (const bool is_left : {true, false}) {
    for (const double length_m : {0.4, 1.5}) {
      Course course = make_alley();
      const double low = is_left ? 0.55 : -0.95;
      course.unknown = {make_box(12.0, 12.0 + length_m, low, low + 0.4)};
      course.range_noise_m = 0.003;
      const Drive result = drive(course);
      EXPECT_TRUE(result.finished);
      EXPECT_GT(result.min_unknown_m, 0.05);
      EXPECT_GT(result.min_known_m, 0.02);
      EXPECT_GT(result.drive_ticks, 0);
      EXPECT_EQ(count_events(result, "sees an obstacle that the map does not have"), 1);
      EXPECT_EQ(count_events(result, "follows the plan again"), 1);
    }
  }
}

TEST(Dwa, TouchesNoBoxWhereverItStands) {
  // From the row to the middle: passes where there is room, else stands; two rangers or four.
  for (const int rangers : {2, 4}) {
    for (const double low : {0.55, 0.45, 0.35, -0.2}) {
      Course course = make_alley();
      course.sensors.resize(rangers);
      course.unknown = {make_box(12.0, 12.4, low, low + 0.4)};
      course.range_noise_m = 0.003;
      course.longest_s = 60.0;
      const Drive result = drive(course);
      EXPECT_GT(result.min_unknown_m, 0.1) << rangers << " " << low;
      EXPECT_GT(result.min_known_m, 0.02) << rangers << " " << low;
      EXPECT_TRUE(result.finished || count_events(result, "blocked at (") == 1)
          << all_events(result);
      if (low > 0.5) {
        EXPECT_TRUE(result.finished);
      }
    }
  }
}

TEST(Dwa, StandsBeforeABoxInTheMiddle) {
  Course course = make_alley();
  course.unknown = {make_box(12.0, 12.5, -0.2, 0.2)};
  course.range_noise_m = 0.003;
  const Drive result = drive(course);
  EXPECT_FALSE(result.finished);
  EXPECT_GT(result.min_unknown_m, 0.1);
  EXPECT_GT(result.min_known_m, 0.02);
  EXPECT_EQ(count_events(result, "blocked at ("), 1);
  EXPECT_EQ(count_events(result, "by an obstacle that the map does not have"), 4);
  // Three, and one more with every fourth try from standing.
  EXPECT_GE(result.reversals, 3);
  EXPECT_LE(result.reversals, 7);
  EXPECT_GT(result.stop_ticks, 500);
}

TEST(Dwa, DrivesOnWhenTheObstacleIsGone) {
  Course course = make_alley();
  course.unknown = {make_box(12.0, 12.5, -0.2, 0.2)};
  course.unknown_until_s = 70.0;
  course.longest_s = 160.0;
  const Drive result = drive(course);
  EXPECT_TRUE(result.finished);
  EXPECT_EQ(count_events(result, "blocked at ("), 1);
  EXPECT_EQ(count_events(result, "follows the plan again"), 1);
}

Course make_turn() {
  // Two alleys 2.5 m apart, a turning area 5 m wide with virtual walls, and a turn of radius 1.8 m.
  Course course;
  const double R = 1.8;
  course.known = {make_box(-10, 0, 0.95, 1.55), make_box(-10, 0, -1.55, -0.95),
                  make_box(-10, 0, 3.45, 4.05), make_box(0, 8, 3.75, 3.8),
                  make_box(0, 8, -1.3, -1.25),  make_box(8, 8.05, -1.3, 3.8)};
  course.grid = Eigen::AlignedBox2d(Eigen::Vector2d(-11, -2), Eigen::Vector2d(9, 4.5));
  // Omega between lanes d apart: out by beta to the right, back round to the left.
  const double d = 2.5;
  const double beta = std::acos(0.5 + 0.25 * d / R);
  course.plan = make_plan(
      {{-8, 0}, 0},
      {{9.3, 0}, {R * beta, -1 / R}, {R * (kPi + 2 * beta), 1 / R}, {R * beta, -1 / R}, {9.3, 0}});
  course.start = {{-8, 0}, 0};
  return course;
}

TEST(Dwa, TurnsByItselfInTheTurningArea) {
  for (const char* mode : {"pure", "assist"}) {
    Course course = make_turn();
    course.values = {{"mode", std::string(mode)}};
    const Drive result = drive(course);
    EXPECT_TRUE(result.finished);
    EXPECT_LE(result.reversals, 3);
    EXPECT_GT(result.min_known_m, 0.0);
  }
}

TEST(Dwa, PureForwardJamsInTheTurnAndRecoveryBringsItThrough) {
  // Weaker hold on the path and a far goal: the vehicle cuts the turn until nothing moves forward.
  Course course = make_turn();
  course.values = {{"mode", std::string("pure")},
                   {"path_weight", 1.0},
                   {"heading_weight", 0.1},
                   {"lookahead_m", 3.0},
                   {"max_recoveries", std::int64_t{0}}};
  course.longest_s = 60.0;
  const Drive forward = drive(course);
  EXPECT_FALSE(forward.finished);
  EXPECT_EQ(count_events(forward, "blocked at ("), 1) << all_events(forward);
  course.values.back().second = std::int64_t{3};
  const Drive result = drive(course);
  EXPECT_TRUE(result.finished);
  EXPECT_GE(result.reversals, 1);
  EXPECT_LE(result.reversals, 3);
  EXPECT_GT(result.min_known_m, 0.02);
  EXPECT_EQ(count_events(result, "held up at ("), result.reversals);
}

TEST(Dwa, PrintedCostLeadsNowhere) {
  Course course = make_alley();
  course.longest_s = 30.0;
  course.values = {{"mode", std::string("pure")}};
  EXPECT_GT(drive(course).end.p.x(), 20.0);
  course.values.push_back({"cost", std::string("printed")});
  EXPECT_LT(drive(course).end.p.x(), 0.1);
}

TEST(Dwa, DrivesTheSameBitsTwiceAndAllocatesNothing) {
  Course course = make_alley();
  course.unknown = {make_box(12.0, 12.5, 0.55, 0.95)};
  course.range_noise_m = 0.003;
  course.longest_s = 30.0;
  const Drive a = drive(course), b = drive(course);
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    ASSERT_EQ(a.poses[i].p, b.poses[i].p);
    ASSERT_EQ(a.poses[i].yaw_rad, b.poses[i].yaw_rad);
    ASSERT_EQ(a.commands[i].front_axle_rad, b.commands[i].front_axle_rad);
  }
  EXPECT_GT(a.drive_ticks, 10);
  EXPECT_EQ(a.allocations, 0u);
}

TEST(Dwa, HoldsTheFootprintsOfEveryKindApart) {
  for (const char* footprint : {"circles", "polygon"}) {
    Course course = make_alley();
    course.unknown = {make_box(12.0, 12.4, 0.55, 0.95)};
    course.values = {{"footprint", std::string(footprint)}};
    const Drive result = drive(course);
    EXPECT_TRUE(result.finished);
    EXPECT_GT(result.min_unknown_m, 0.05);
  }
}

/// What building the part says, with some parameters and a changed vehicle.
template <class Change>
std::string refusal(const Values& values, Change&& change) {
  VehicleDescription vehicle = make_four_wheel_rover();
  change(vehicle);
  try {
    Loop({.description = vehicle}).add_guidance({"dwa", values});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Dwa, RefusesWithOneSentence) {
  const auto same = [](VehicleDescription&) {};
  EXPECT_EQ(refusal({}, same), "accepted");
  EXPECT_EQ(refusal({{"circle_radius_m", 0.4}}, same),
            "rover.guidance (dwa): circles of circle_radius_m = 0.4 m, circle_spacing_m = 0.5 m "
            "leave 0.176 m of the outline of vehicle type 'four_wheel_steering_rover' uncovered, "
            "more than margin_m = 0.05 m");
  EXPECT_EQ(refusal({{"step_s", 0.01}}, same),
            "rover.guidance (dwa): rollouts of 1.6 s (stopping from 1.6 m/s at acceleration_mps2 = "
            "0.5 m/s2) need 160 steps of step_s = 0.01 s, at most 64 are possible");
  EXPECT_EQ(refusal({{"horizon_s", 8.0}}, same),
            "rover.guidance (dwa): rollouts of 8 s (horizon_s) need 80 steps of step_s = 0.1 s, at "
            "most 64 are possible");
  // Motions below 0.03 m/s count as none, and a jam must last longer than the start of a drive.
  for (const auto& [name, value] :
       {std::pair{"speed_mps", 0.04}, std::pair{"window_s", 0.009},
        std::pair{"reverse_speed_mps", 0.04}, std::pair{"stall_s", 0.4}}) {
    EXPECT_NE(refusal({{name, value}}, same).find(std::string(name) + " = "), std::string::npos);
  }
  EXPECT_NE(refusal({{"step_s", 5.0}}, same).find("step_s = 5 s is longer than horizon_s = 1.4 s"),
            std::string::npos);
  // No command would be better than another, and none would be driven.
  EXPECT_EQ(
      refusal({{"clearance_weight", 0.0}, {"goal_weight", 0.0}, {"cost", std::string("printed")}},
              same),
      "rover.guidance (dwa): clearance_weight and goal_weight are both 0");
  const auto none = refusal({{"clearance_weight", 0.0},
                             {"goal_weight", 0.0},
                             {"heading_weight", 0.0},
                             {"path_weight", 0.0}},
                            same);
  EXPECT_EQ(none,
            "rover.guidance (dwa): clearance_weight, goal_weight, heading_weight and path_weight "
            "are all 0");
  EXPECT_EQ(refusal({{"clearance_weight", 0.0}, {"goal_weight", 0.0}}, same), "accepted");
  EXPECT_EQ(refusal({{"mode", std::string("pur")}}, same).find("mode"), 0u);
  EXPECT_NE(refusal({{"horizon_s", 0.0}}, same).find("horizon_s = 0 s, must be > 0"),
            std::string::npos);
  EXPECT_EQ(refusal({}, [](VehicleDescription& v) { v.steered.reset(); }),
            "rover.guidance (dwa) needs a vehicle with two steered axles; vehicle type "
            "'four_wheel_steering_rover' has wheels");
  EXPECT_EQ(refusal({}, [](VehicleDescription& v) { v.steered->rear_axle_m = -0.75; }),
            "rover.guidance (dwa) needs 'rear_axle_m' > 0, but vehicle type "
            "'four_wheel_steering_rover' has -0.75");
  EXPECT_EQ(refusal({}, [](VehicleDescription& v) { v.max_speed_mps.reset(); }),
            "rover.guidance (dwa) needs 'max_speed_mps', which vehicle type "
            "'four_wheel_steering_rover' does not have");
}

TEST(Dwa, StandingWhereTheAuthorityEndsIsNoJam) {
  // Another vehicle stands across the alley behind the place.
  Course course = make_alley();
  course.unknown = {make_box(11.0, 12.0, -0.95, 0.95)};
  course.longest_s = 100.0;
  course.stop_at_m = [](double) { return 9.0; };
  const Drive result = drive(course);
  EXPECT_FALSE(result.finished);
  EXPECT_EQ(result.reversals, 0);
  EXPECT_EQ(result.drive_ticks, 0);
  for (const Event& event : result.events) {
    EXPECT_NE(event.text.find("sees an obstacle"), std::string::npos) << event.text;
  }
  for (const controllers::Pose2& pose : result.poses) ASSERT_LE(pose.p.x(), 9.1);
  EXPECT_GE(result.end.p.x(), 8.7);
  EXPECT_EQ(result.poses[300].p, result.end.p);
}

TEST(Dwa, GoesOnWhenTheAuthorityDoes) {
  Course course = make_alley();
  course.stop_at_m = [](double time_s) {
    return time_s < 40.0 ? 9.0 : std::numeric_limits<double>::infinity();
  };
  const Drive result = drive(course);
  EXPECT_TRUE(result.finished);
  EXPECT_EQ(result.reversals, 0);
  EXPECT_EQ(result.drive_ticks, 0);
  EXPECT_TRUE(result.events.empty());
  EXPECT_EQ(result.poses[300].p, result.poses[399].p);
}

TEST(Dwa, DrivingBesideThePlanItStopsAsWell) {
  Course course = make_alley();
  course.values = {{"mode", std::string("pure")}};
  course.stop_at_m = [](double time_s) {
    return time_s < 40.0 ? 9.0 : std::numeric_limits<double>::infinity();
  };
  const Drive result = drive(course);
  EXPECT_TRUE(result.finished);
  EXPECT_GT(result.drive_ticks, 100);
  EXPECT_EQ(result.reversals, 0);
  for (std::size_t i = 0; i < 400; ++i) ASSERT_LE(result.poses[i].p.x(), 9.1);
  EXPECT_GE(result.poses[390].p.x(), 8.7);
}

}  // namespace
}  // namespace vinerow::test::dwa_test
