// Guidance `waypoint_guidance` from the launcher to the ground.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "engine/api/may_fail.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/waypoint_guidance/air_bench.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::air_mission_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

PlaneOptions on_launcher(double yaw_rad = 0.0) {
  PlaneOptions options;
  options.is_flying = false;
  options.yaw_rad = yaw_rad;
  options.start_W = {5.0, -3.0, 0.1};
  return options;
}

PlaneOptions in_the_air(const Eigen::Vector3d& start_W, double yaw_rad) {
  PlaneOptions options;
  options.start_W = start_W;
  options.yaw_rad = yaw_rad;
  return options;
}

/// Phases in the order in which they came.
struct Phases {
  std::vector<AirPhase> seen;
  void add(AirPhase phase) {
    if (seen.empty() || seen.back() != phase) seen.push_back(phase);
  }
};

TEST(AirMission, LaunchesStraightAheadAndFliesToTheFirstWaypoint) {
  AirBench bench({{"end", std::string("stop")}}, on_launcher(0.3));
  bench.give_plan(make_waypoints({{300, 250, 40}, {700, 250, 40}}));
  Phases phases;
  double power_s = -1.0, launched_m = 0.0;
  bench.fly(120.0, [&](double time_s, const Odometry& seen, const AirReference& reference) {
    phases.add(reference.phase);
    if (reference.power && power_s < 0.0) power_s = time_s;
    if (reference.phase == AirPhase::kWait) {
      EXPECT_NEAR(reference.height_m, 0.1, 1e-12);
    }
    if (reference.phase != AirPhase::kLaunch) return;
    launched_m = seen.X_WB.p.z();
    EXPECT_NEAR(reference.heading_rad, 0.3, 1e-9);
    // The ramp of the launch begins at the launcher; a tick behind, and rounded at its foot.
    const double flown_m = (seen.X_WB.p - Eigen::Vector3d(5, -3, 0.1)).head<2>().norm();
    EXPECT_LE(reference.height_m, 0.1 + flown_m * std::tan(rad_from_deg(10.0)) + 0.2);
    EXPECT_LE(reference.climb_angle_rad, rad_from_deg(10.0) + 1e-9);
  });
  EXPECT_NEAR(power_s, 1.0, 1e-9);
  EXPECT_NEAR(launched_m, 20.1, 0.3);
  EXPECT_THAT(phases.seen,
              ElementsAre(AirPhase::kWait, AirPhase::kLaunch, AirPhase::kTurn, AirPhase::kStraight,
                          AirPhase::kTurn, AirPhase::kStraight, AirPhase::kDone));
  EXPECT_TRUE(bench.has_event("launches on bearing 73 deg for 400 m of plan"));
}

TEST(AirMission, EventsTellBearingsFromNorth) {
  EXPECT_EQ(controllers::bearing_deg(0.0), 90.0);
  EXPECT_EQ(controllers::bearing_deg(rad_from_deg(90.0)), 0.0);
  EXPECT_EQ(controllers::bearing_deg(rad_from_deg(90.4)), 0.0);
  EXPECT_EQ(controllers::bearing_deg(rad_from_deg(150.0)), 300.0);
  EXPECT_EQ(controllers::bearing_deg(rad_from_deg(-180.0)), 270.0);
  EXPECT_EQ(controllers::bearing_deg(rad_from_deg(1.0 + 720.0)), 89.0);
}

TEST(AirMission, CirclesWhereTheWayIsTooShortToClimb) {
  AirBench bench({{"end", std::string("stop")}}, on_launcher());
  bench.give_plan(make_waypoints({{200, 60, 150}, {200, 500, 150}}));
  Phases phases;
  double circled_rad = 0.0, yaw_rad = 0.0, min_m = 1e9;
  bench.fly(300.0, [&](double, const Odometry& seen, const AirReference& reference) {
    phases.add(reference.phase);
    const double now_rad = yaw_from_quaternion(seen.X_WB.q);
    if (reference.phase == AirPhase::kLoiter) circled_rad += wrap_angle(now_rad - yaw_rad);
    yaw_rad = now_rad;
    EXPECT_LE(reference.climb_angle_rad, rad_from_deg(10.0) + 1e-9);
    if (reference.waypoint == 1) {
      min_m = std::min(min_m, seen.X_WB.p.z());
    }
  });
  // 130 m at 10 deg are 737 m, of which 200 m lie on the way: more than two circles of 31.5 m.
  EXPECT_GT(circled_rad, 4.0 * kPi);
  EXPECT_GT(min_m, 148.0);
  EXPECT_EQ(phases.seen[2], AirPhase::kLoiter);
  EXPECT_EQ(phases.seen.back(), AirPhase::kDone);
}

TEST(AirMission, FliesOnUntilItCanTurnToAWaypointBesideTheLauncher) {
  for (const Eigen::Vector3d& first : {Eigen::Vector3d(125, 20, 25), Eigen::Vector3d(60, -30, 25),
                                       Eigen::Vector3d(-40, 3, 25), Eigen::Vector3d(5, -3, 25)}) {
    AirBench bench({{"end", std::string("stop")}}, on_launcher());
    bench.give_plan(make_waypoints({first, first + Eigen::Vector3d(0, 300, 0)}));
    AirPhase last = AirPhase::kWait;
    bench.fly(150.0, [&](double, const Odometry&, const AirReference& now) { last = now.phase; });
    EXPECT_EQ(last, AirPhase::kDone) << first.transpose();
    EXPECT_LT(bench.time_s(), 90.0) << first.transpose();
  }
}

TEST(AirMission, PlanThatLeadsOffTheLauncherIsNotFlownBackTo) {
  PlannedPath plan = make_waypoints({{5, -3, 60}, {400, 0, 60}, {800, 0, 60}});
  plan.points[0].kind = PathKind::kTransit;
  AirBench bench({{"end", std::string("stop")}}, on_launcher());
  bench.give_plan(plan);
  double back_m = 0.0, far_m = 0.0, last_m = 0.0;
  bench.fly(120.0, [&](double, const Odometry& seen, const AirReference& reference) {
    back_m = std::max(back_m, far_m - seen.X_WB.p.x());
    far_m = std::max(far_m, seen.X_WB.p.x());
    EXPECT_GE(reference.distance_m, last_m - 1.0);
    last_m = reference.distance_m;
    EXPECT_NEAR(reference.distance_m + reference.remaining_m, 795.01, 0.1);
  });
  EXPECT_LT(back_m, 0.1);
  EXPECT_NEAR(last_m, 795.0, 1.0);
}

TEST(AirMission, StartInTheAirIsADeviationFromThePlan) {
  // 14 m low and 24 deg off, as in the stress test of the reference.
  AirBench bench({{"end", std::string("stop")}}, in_the_air({0, 0, 86}, rad_from_deg(24.0)));
  bench.give_plan(make_waypoints({{-50, 0, 100}, {400, 0, 100}}));
  const AirReference first = bench.tick();
  EXPECT_EQ(first.phase, AirPhase::kStraight);
  EXPECT_TRUE(first.power);
  EXPECT_NEAR(first.heading_rad, 0.0, 1e-12);
  EXPECT_NEAR(first.height_m, 100.0, 1e-12);
  EXPECT_NEAR(first.bank_rad, 0.0, 1e-12);
  EXPECT_NEAR(first.distance_m, 50.0, 1e-9);
}

TEST(AirMission, StartInTheAirTheOtherWayRoundBeginsAtTheVehicle) {
  AirBench bench({{"end", std::string("stop")}}, in_the_air({0, 0, 60}, rad_from_deg(150.0)));
  bench.give_plan(make_waypoints({{-50, 0, 100}, {600, 0, 100}}));
  const AirReference first = bench.tick();
  EXPECT_NEAR(first.heading_rad, rad_from_deg(150.0), 1e-12);
  EXPECT_NEAR(first.height_m, 60.0, 1e-12);
  double off_rad = 0.0;
  AirReference last;
  bench.fly(120.0, [&](double, const Odometry& seen, const AirReference& now) {
    off_rad =
        std::max(off_rad, std::abs(wrap_angle(yaw_from_quaternion(seen.X_WB.q) - now.heading_rad)));
    if (now.phase != AirPhase::kDone) last = now;
  });
  EXPECT_LT(off_rad, rad_from_deg(10.0));
  EXPECT_EQ(last.phase, AirPhase::kStraight);
  EXPECT_NEAR(last.remaining_m, 0.0, 1.0);
  EXPECT_LT(std::abs(last.cross_track_m), 0.1);
  EXPECT_NEAR(last.height_m, 100.0, 0.1);
}

TEST(AirMission, StartInTheAirFarFromThePlanFliesToItsStart) {
  AirBench bench({{"end", std::string("stop")}}, in_the_air({0, 300, 80}, 0.0));
  bench.give_plan(make_waypoints({{100, 0, 100}, {400, 0, 100}}));
  const AirReference first = bench.tick();
  EXPECT_NEAR(first.height_m, 80.0, 1e-12);
  double nearest_m = 1e9;
  AirReference last;
  bench.fly(120.0, [&](double, const Odometry& seen, const AirReference& now) {
    nearest_m = std::min(nearest_m, (seen.X_WB.p - Eigen::Vector3d(100, 0, 100)).norm());
    last = now;
  });
  EXPECT_LT(nearest_m, 21.0);
  EXPECT_EQ(last.phase, AirPhase::kDone);
  EXPECT_NEAR(last.distance_m, 300.0, 1.0);
}

TEST(AirMission, CirclesAboutTheLastWaypointForItsTime) {
  for (const char* side : {"left", "right"}) {
    for (const Eigen::Vector2d& wind : {Eigen::Vector2d(0, 0), Eigen::Vector2d(3, 2)}) {
      PlaneOptions options = in_the_air({0, 0, 100}, 0.0);
      options.wind = wind;
      AirBench bench({{"end", std::string("loiter")},
                      {"loiter_s", 90.0},
                      {"loiter_radius_m", 50.0},
                      {"loiter_side", std::string(side)}},
                     options);
      bench.give_plan(make_waypoints({{0, 0, 100}, {200, 0, 100}}));
      double began_s = 0.0, ended_s = 0.0, off_m = 0.0, turned_rad = 0.0, yaw_rad = 0.0;
      bench.fly(300.0, [&](double time_s, const Odometry& seen, const AirReference& reference) {
        if (reference.phase == AirPhase::kLoiter && began_s == 0.0) began_s = time_s;
        if (reference.phase == AirPhase::kDone) ended_s = time_s;
        const double now_rad = yaw_from_quaternion(seen.X_WB.q);
        if (began_s > 0.0) turned_rad += wrap_angle(now_rad - yaw_rad);
        yaw_rad = now_rad;
        if (began_s == 0.0 || time_s < began_s + 30.0) return;
        off_m = std::max(off_m,
                         std::abs((seen.X_WB.p.head<2>() - Eigen::Vector2d(200, 0)).norm() - 50.0));
        EXPECT_TRUE(reference.phase == AirPhase::kDone || reference.power);
      });
      EXPECT_NEAR(ended_s - began_s, 90.0, 0.2);
      // The mission is over, and it stays where it is as long as others are at work.
      for (int i = 0; i < 1200; ++i) {
        const AirReference& after = bench.tick();
        ASSERT_EQ(after.phase, AirPhase::kDone);
        ASSERT_TRUE(after.power);
        ASSERT_EQ(after.remaining_m, 0.0);
        const Eigen::Vector3d p_W = bench.plane.odometry().X_WB.p;
        off_m = std::max(off_m, std::abs((p_W.head<2>() - Eigen::Vector2d(200, 0)).norm() - 50.0));
        ASSERT_NEAR(p_W.z(), 100.0, 0.5);
      }
      EXPECT_LT(off_m, wind.norm() > 0.0 ? 2.5 : 0.6) << side;
      EXPECT_GT((std::string(side) == "left" ? 1.0 : -1.0) * turned_rad, 4.0 * kPi);
    }
  }
}

TEST(AirMission, StopsAtTheLastWaypointAndCirclesThere) {
  AirBench bench({{"end", std::string("stop")}}, in_the_air({0, 0, 100}, 0.0));
  bench.give_plan(make_waypoints({{0, 0, 100}, {200, 0, 90}}));
  double ended_s = 0.0;
  bench.fly(60.0, [&](double time_s, const Odometry&, const AirReference& reference) {
    if (reference.phase == AirPhase::kDone) ended_s = time_s;
    EXPECT_NE(reference.phase, AirPhase::kLoiter);
  });
  EXPECT_NEAR(ended_s, 200.0 / 12.0, 0.5);
  for (int i = 0; i < 1200; ++i) {
    ASSERT_TRUE(bench.tick().power);
    const Eigen::Vector3d away = bench.plane.odometry().X_WB.p - Eigen::Vector3d(200, 0, 90);
    ASSERT_NEAR(away.z(), 0.0, 1.0);
    // Out of the middle within half a minute, then along the circle of 1.5 radii of a turn.
    if (i > 600) {
      ASSERT_NEAR(away.head<2>().norm(), 31.5, 0.6);
    }
  }
}

TEST(AirMission, AirspeedChangesByItsRate) {
  PlannedPath plan = make_waypoints({{0, 0, 100}, {200, 0, 100}, {600, 0, 100}});
  plan.points[0].speed_mps = 12.0;
  plan.points[1].speed_mps = plan.points[2].speed_mps = 15.0;
  AirBench bench({{"end", std::string("stop")}, {"airspeed_rate_mps2", 0.75}},
                 in_the_air({0, 0, 100}, 0.0));
  bench.give_plan(plan);
  double before_mps = 12.0, began_s = 0.0, reached_s = 0.0;
  bench.fly(60.0, [&](double time_s, const Odometry&, const AirReference& reference) {
    if (reference.phase == AirPhase::kWait) return;
    EXPECT_LE(std::abs(reference.airspeed_mps - before_mps), 0.75 * 0.05 + 1e-9);
    if (reference.airspeed_mps > 12.0 && began_s == 0.0) began_s = time_s;
    if (reference.airspeed_mps == 15.0 && reached_s == 0.0) reached_s = time_s;
    before_mps = reference.airspeed_mps;
  });
  EXPECT_GT(began_s, 10.0);
  EXPECT_NEAR(reached_s - began_s, 4.0, 0.1);  // 3 m/s by 0.75 m/s2
}

TEST(AirMission, LandsAtItsStartAgainstTheWind) {
  for (const Eigen::Vector2d& wind : {Eigen::Vector2d(0, 0), Eigen::Vector2d(0, -4)}) {
    PlaneOptions options = on_launcher(0.3);
    options.wind = wind;
    AirBench bench({}, options);
    bench.give_plan(make_waypoints({{200, 200, 80}, {500, 200, 80}, {500, 400, 80}}));
    Phases phases;
    double power_off_m = -1.0, min_climb_mps = 0.0, touch_climb_mps = 0.0, glide_yaw_rad = 0.0;
    Eigen::Vector2d touch(1e9, 1e9);
    bench.fly(600.0, [&](double, const Odometry& seen, const AirReference& reference) {
      phases.add(reference.phase);
      const double climb_mps = (seen.X_WB.q * seen.v_WB_B).z();
      min_climb_mps = std::min(min_climb_mps, climb_mps);
      if (reference.phase != AirPhase::kLand) return;
      if (!reference.power && power_off_m < 0.0) power_off_m = seen.X_WB.p.z() - 0.05;
      if (seen.X_WB.p.z() > 0.06) {
        touch_climb_mps = climb_mps;
        touch = seen.X_WB.p.head<2>();
        glide_yaw_rad = yaw_from_quaternion(seen.X_WB.q);
      }
    });
    EXPECT_EQ(phases.seen.back(), AirPhase::kDone) << wind.transpose();
    ASSERT_GE(phases.seen.size(), 3u);
    EXPECT_EQ(phases.seen[phases.seen.size() - 2], AirPhase::kLand);
    EXPECT_EQ(phases.seen[phases.seen.size() - 3], AirPhase::kLoiter);
    EXPECT_NEAR(power_off_m, 0.1, 0.06);
    EXPECT_GT(touch_climb_mps, -0.6);
    EXPECT_GT(min_climb_mps, -12.0 * std::sin(rad_from_deg(12.0)));
    EXPECT_LT((touch - Eigen::Vector2d(5, -3)).norm(), 25.0) << wind.transpose();
    EXPECT_NEAR(wrap_angle(glide_yaw_rad - (wind.norm() > 0.0 ? 0.5 * kPi : 0.3)), 0.0,
                rad_from_deg(3.0));
    EXPECT_TRUE(bench.has_event("landed at"));
  }
}

TEST(AirMission, FailsWhereItLandsTooFarOff) {
  const auto fly = [](double tolerance_m) {
    AirBench bench({{"land_tolerance_m", tolerance_m}}, on_launcher(0.3));
    bench.give_plan(make_waypoints({{200, 200, 80}, {500, 200, 80}}));
    bench.fly(600.0);
    EXPECT_TRUE(bench.has_event("landed at"));
    return std::string(dynamic_cast<const MayFail&>(bench.guidance()).failure());
  };
  EXPECT_EQ(fly(50.0), "");
  const std::string failure = fly(0.01);
  EXPECT_TRUE(failure.starts_with("landed at (")) << failure;
  EXPECT_TRUE(failure.ends_with("m from the planned touchdown, at most 0.01 m (land_tolerance_m)"))
      << failure;
}

TEST(AirMission, TakesTheLandingsBearingFromNorthAndItsOldFormWithAWarning) {
  const auto glide_yaw = [](const Values& values, bool warns) {
    AirBench bench(values, on_launcher(0.3));
    bench.give_plan(make_waypoints({{200, 200, 80}, {500, 200, 80}}));
    double yaw_rad = 0.0;
    bench.fly(600.0, [&](double, const Odometry& seen, const AirReference& reference) {
      if (reference.phase == AirPhase::kLand && seen.X_WB.p.z() > 0.06) {
        yaw_rad = yaw_from_quaternion(seen.X_WB.q);
      }
    });
    EXPECT_EQ(bench.has_event("land_course_deg = -30 counts from east to the left and is old: "
                              "write land_bearing_deg: 120"),
              warns);
    return yaw_rad;
  };
  // South-east by south: 120 deg clockwise from north is 30 deg right of east.
  EXPECT_NEAR(glide_yaw({{"land_bearing_deg", 120.0}}, false), rad_from_deg(-30.0),
              rad_from_deg(3.0));
  EXPECT_NEAR(glide_yaw({{"land_course_deg", -30.0}}, true), rad_from_deg(-30.0),
              rad_from_deg(3.0));
}

TEST(AirMission, ReferenceHasNoStepsFromLaunchToLanding) {
  PlaneOptions options = on_launcher(-2.0);
  options.wind = {2.5, 1.5};
  AirBench bench({{"land_course_deg", 200.0}, {"loiter_side", std::string("right")}}, options);
  bench.give_plan(make_lanes(4, 200, 60, 90, 0.7));
  AirReference before;
  int ticks = 0;
  const double turn_radps = 9.80665 * std::tan(rad_from_deg(35.0)) / 12.0;
  bench.fly(900.0, [&](double, const Odometry& seen, const AirReference& now) {
    const bool flies = now.phase != AirPhase::kWait && now.phase != AirPhase::kDone;
    if (ticks++ > 0 && flies && before.phase != AirPhase::kWait) {
      ASSERT_LE(std::abs(now.heading_rad - before.heading_rad), 0.05 * turn_radps + 1e-9);
      ASSERT_LE(std::abs(now.bank_rad - before.bank_rad), 0.05 * rad_from_deg(60.0) + 1e-9);
      ASSERT_LE(std::abs(now.height_m - before.height_m), 0.05 * 12.0 * std::sin(0.18) + 1e-9);
      ASSERT_NEAR(now.height_m - before.height_m,
                  0.05 * now.airspeed_mps * std::sin(now.climb_angle_rad), 1e-9);
      ASSERT_LE(std::abs(now.bank_rad), rad_from_deg(35.0) + 1e-9);
      ASSERT_GE(now.remaining_m, 0.0);
    }
    ASSERT_LT(seen.X_WB.p.z(), 95.0);
    before = now;
  });
  EXPECT_EQ(before.phase, AirPhase::kDone);
}

TEST(AirMission, HeightFollowsRampsThroughTheTurns) {
  // Lanes that rise and fall by 10 %, in opposite directions side by side.
  PlannedPath plan = make_lanes(4, 300, 45, 100);
  for (PathPoint& point : plan.points) point.p_W.z() += 0.1 * point.p_W.y();
  AirBench bench({{"end", std::string("stop")}}, in_the_air({0, 0, 100}, 0.5 * kPi));
  bench.give_plan(plan);
  double off_m = 0.0, square = 0.0;
  int count = 0;
  bench.fly(300.0, [&](double, const Odometry& seen, const AirReference& reference) {
    const double error_m = seen.X_WB.p.z() - reference.height_m;
    square += error_m * error_m;
    ++count;
    const double y = seen.X_WB.p.y();
    if (reference.phase == AirPhase::kStraight && y > 60.0 && y < 240.0) {
      off_m = std::max(off_m, std::abs(reference.height_m - (100.0 + 0.1 * y)));
    }
  });
  EXPECT_LT(off_m, 0.1);
  EXPECT_LT(std::sqrt(square / count), 0.5);
}

TEST(AirMission, EstimatesThatAreNoNumbersAreIgnored) {
  AirBench bench({{"end", std::string("stop")}}, in_the_air({0, 0, 100}, 0.0));
  bench.give_plan(make_waypoints({{0, 0, 100}, {300, 0, 100}}));
  Odometry broken = bench.plane.odometry();
  broken.X_WB.p.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(bench.step(broken).phase, AirPhase::kWait);
  for (int i = 0; i < 40; ++i) bench.tick();
  const AirReference before = bench.tick();
  const AirReference after = bench.step(broken);
  EXPECT_EQ(after.phase, before.phase);
  EXPECT_EQ(after.heading_rad, before.heading_rad);
  EXPECT_EQ(after.height_m, before.height_m);
  EXPECT_EQ(after.distance_m, before.distance_m);
  bench.fly(60.0);
  EXPECT_TRUE(bench.has_event("ends its mission in the air at the last waypoint, after 300 m"));
}

TEST(AirMission, TellsOfPlansThatCannotBeFlown) {
  AirBench bench({}, in_the_air({0, 0, 100}, 0.0));
  bench.give_plan(make_waypoints({{0, 0, 100}}));
  EXPECT_EQ(bench.tick().phase, AirPhase::kWait);
  ASSERT_EQ(bench.events().size(), 1u);
  EXPECT_EQ(bench.events()[0].text,
            "plan has 1 waypoint apart from each other, needs two or more: waits for another");
  bench.give_plan(make_lanes(3, 200, 30, 100));
  EXPECT_EQ(bench.tick().phase, AirPhase::kStraight);
  EXPECT_TRUE(bench.has_event("the turns there take 41.9 m"));
}

void expect_refused(const Values& values, const std::string& sentence,
                    VehicleDescription vehicle = make_plane_description()) {
  try {
    AirBench bench(values, {}, "waypoint_guidance", std::move(vehicle));
    FAIL() << "must be refused: " << sentence;
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr(sentence));
  }
}

TEST(AirMission, RefusesParametersThatCannotBeFlown) {
  const std::string who = "plane.guidance (waypoint_guidance): ";
  expect_refused({{"airspeed_mps", 9.0}},
                 who +
                     "airspeed_mps = 9.00 m/s is not above the 9.28 m/s at which vehicle type "
                     "'fixed_wing' stalls in a level turn at 35.0 deg of bank");
  expect_refused({{"airspeed_mps", 22.0}},
                 who +
                     "airspeed_mps = 22.00 m/s is more than the 20.00 m/s that vehicle type "
                     "'fixed_wing' can fly");
  expect_refused({{"bank_deg", 50.0}}, who +
                                           "bank_deg = 50.0 deg is more than the 45.0 deg that "
                                           "vehicle type 'fixed_wing' can fly");
  expect_refused({{"loiter_radius_m", 15.0}},
                 who +
                     "loiter_radius_m = 15.0 m is less than the 21.0 m of a turn at 12.0 m/s and "
                     "35.0 deg of bank");
  expect_refused({{"end", std::string("stop")}, {"land_course_deg", 90.0}},
                 who + "land_course_deg describes a landing, but end is 'stop'");
  expect_refused({{"approach_speed_mps", 8.0}},
                 who +
                     "approach_speed_mps = 8.00 m/s is not above the 8.40 m/s at which vehicle "
                     "type 'fixed_wing' stalls");
  expect_refused({{"flare_height_m", 40.0}},
                 who + "flare_height_m = 40.00 m is not below approach_height_m = 30.00 m");
  expect_refused({{"approach_speed_mps", 22.0}},
                 who +
                     "approach_speed_mps = 22.00 m/s is more than the 20.00 m/s that vehicle type "
                     "'fixed_wing' can fly");
  // 5 km of height at 2 deg: 143 km.
  expect_refused(
      {{"approach_height_m", 5000.0}, {"glide_deg", 2.0}},
      who +
          "approach_height_m = 5000 m, flare_height_m = 1.5 m and glide_deg = 2 deg make "
          "a glide of 143 km, must be at most 100 km");
  expect_refused({{"glide_deg", 1e-6}}, "glide_deg = 1e-06 deg, must be >= 0.5 deg and <= 30 deg");
  expect_refused({{"bank_deg", 1e-5}}, "bank_deg = 1e-05 deg, must be >= 1 deg and <= 80 deg");
  VehicleDescription rover;
  rover.type = "rover";
  rover.wheeled.emplace();
  expect_refused({}, "needs a vehicle with wings; vehicle type 'rover' has wheels", rover);
}

}  // namespace
}  // namespace vinerow::test::air_mission_test
