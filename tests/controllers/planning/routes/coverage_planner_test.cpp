#include "controllers/planning/routes/coverage_planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "controllers/planning/routes/alley_order.h"
#include "controllers/planning/routes/waypoints.h"
#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/mission.h"
#include "tests/support/plain_scene.h"

namespace vinerow::test::coverage_test {
namespace {

using Text = std::string;

const RowMap kNoRows;  // outlives the planners that refer to it

/// Rows 2.5 m apart, 17 m long, and the alleys between them.
RowMap make_narrow_map(int alleys = 9, double pitch_m = 2.5) {
  RowMap map;
  for (int i = 0; i <= alleys; ++i) {
    PlantRow row;
    row.id = i;
    row.line_W = {{pitch_m * i, 0.0, 0.0}, {pitch_m * i, 17.0, 0.0}};
    map.rows.push_back(row);
  }
  for (int i = 0; i < alleys; ++i) {
    const double x = pitch_m * (i + 0.5);
    map.alleys.push_back({i, {{x, 0.0, 0.0}, {x, 17.0, 0.0}}, pitch_m});
  }
  return map;
}

Result<PlannedPath> plan(const RowMap& map, const Values& values,
                         controllers::Pose2 start = {{1.25, 0}, 0.5 * kPi}) {
  return make_planner({"coverage", values}, map)
      ->plan({quaternion_from_rpy({0, 0, start.yaw_rad}), {start.p.x(), start.p.y(), 0.3}});
}

std::vector<int> alleys_of(const PlannedPath& path) {
  std::vector<int> alleys;
  for (const PathPoint& point : path.points) {
    if (point.alley >= 0 && (alleys.empty() || alleys.back() != point.alley)) {
      alleys.push_back(point.alley);
    }
  }
  return alleys;
}

void expect_smooth(const PlannedPath& path) {
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const PathPoint &a = path.points[i], &b = path.points[i + 1];
    const Eigen::Vector2d chord = (b.p_W - a.p_W).head<2>();
    ASSERT_GT(chord.norm(), 1e-6);
    // The heading of a point, turned by its curvature, is the heading of the next.
    const double turn = 2.0 * std::asin(0.5 * chord.norm() * a.curvature_per_m);
    ASSERT_NEAR(wrap_angle(b.yaw_rad - a.yaw_rad - turn), 0.0, 1e-9) << i;
    ASSERT_NEAR(wrap_angle(std::atan2(chord.y(), chord.x()) - a.yaw_rad - 0.5 * turn), 0.0, 1e-9);
  }
}

TEST(Coverage, DrivesEveryAlleyInSerpentines) {
  const auto path = plan(make_narrow_map(), {});
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(alleys_of(*path), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_NEAR(path->length_m, 9 * 17.0 + 8 * 1.25 * kPi, 1e-9);
  expect_smooth(*path);
}

TEST(Coverage, StartsAtTheNearerEnd) {
  const auto path = plan(make_narrow_map(), {}, {{1.25, 18.0}, -0.5 * kPi});
  ASSERT_TRUE(path.ok());
  EXPECT_NEAR(path->points.front().p_W.y(), 18.0, 1e-9);
  EXPECT_EQ(path->points.front().kind, PathKind::kTransit);
  EXPECT_NEAR(path->length_m, 1.0 + 9 * 17.0 + 8 * 1.25 * kPi, 1e-9);
}

TEST(Coverage, ApproachesByADubinsPathFromAside) {
  const auto path = plan(make_narrow_map(), {}, {{-3.0, -4.0}, 0.0});
  ASSERT_TRUE(path.ok());
  EXPECT_NEAR((path->points.front().p_W.head<2>() - Eigen::Vector2d(-3, -4)).norm(), 0.0, 1e-9);
  expect_smooth(*path);
  const auto bare = plan(make_narrow_map(), {{"approach", false}}, {{-3.0, -4.0}, 0.0});
  ASSERT_TRUE(bare.ok());
  EXPECT_EQ(bare->points.front().kind, PathKind::kLeg);
}

TEST(Coverage, HeadlandAndLeadsLengthenThePath) {
  const auto path =
      plan(make_narrow_map(2), {{"headland_m", 1.0}, {"lead_in_m", 2.0}, {"lead_out_m", 3.0}},
           {{1.25, -2.0}, 0.5 * kPi});
  ASSERT_TRUE(path.ok());
  EXPECT_NEAR(path->length_m, 2.0 + 2 * 17.0 + 2 * 1.0 + 1.25 * kPi + 3.0, 1e-9);
  EXPECT_NEAR(path->points.back().p_W.y(), -3.0, 1e-9);
  expect_smooth(*path);
}

TEST(Coverage, DubinsTurnsFitAnySpacing) {
  // Radius 2 between alleys 2.5 m apart is a loop; radius 0.8 two quarters and a straight.
  for (const double radius : {0.8, 1.25, 2.0}) {
    const auto path =
        plan(make_narrow_map(),
             {{"turn", Text("dubins")}, {"turn_radius_m", radius}, {"headland_m", 2.5}});
    ASSERT_TRUE(path.ok());
    expect_smooth(*path);
    double sharpest = 0.0;
    for (const PathPoint& point : path->points) {
      sharpest = std::max(sharpest, std::abs(point.curvature_per_m));
    }
    EXPECT_NEAR(sharpest, 1.0 / radius, 1e-9);
  }
}

TEST(Coverage, LevelsTheEndsOfSlantingBlocks) {
  RowMap map = make_narrow_map(3);
  for (std::size_t i = 0; i < map.alleys.size(); ++i) {
    for (Eigen::Vector3d& p : map.alleys[i].line_W) p.y() += 0.8 * static_cast<double>(i);
  }
  for (PlantRow& row : map.rows) {
    for (Eigen::Vector3d& p : row.line_W) p.y() += 0.8 * (row.id - 0.5);
  }
  const auto path = plan(map, {});
  ASSERT_TRUE(path.ok()) << path.reason();
  expect_smooth(*path);
}

TEST(Coverage, ApexOtherThanHalfTheSpacingIsThePapersArc) {
  // Paper B's alleys with the apex 4 m out: radius (5^2 + 4^2) / 8.
  MissionSetup setup = make_paper_mission();
  setup.planner.values.push_back({"apex_m", 4.0});
  const PlannedPath path = plan_mission(setup);
  double sharpest = 0.0, highest = 0.0;
  for (const PathPoint& point : path.points) {
    sharpest = std::max(sharpest, std::abs(point.curvature_per_m));
    highest = std::max(highest, point.p_W.y());
  }
  EXPECT_NEAR(sharpest, 8.0 / 41.0, 1e-9);
  EXPECT_NEAR(highest, 94.0, 1e-3);  // the waypoint nearest to the apex
}

TEST(Coverage, SkipsNeighboursForWideTurns) {
  for (int count = 1; count <= 12; ++count) {
    const std::vector<int> order =
        controllers::make_alley_order(count, controllers::AlleyOrder::kSkip);
    std::vector<int> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < count; ++i) ASSERT_EQ(sorted[i], i);
    for (int i = 0; count >= 5 && i + 1 < count; ++i) {
      EXPECT_GE(std::abs(order[i + 1] - order[i]), 2) << count;
    }
  }
  const auto path = plan(make_narrow_map(), {{"order", Text("skip")}, {"turn_radius_m", 2.5}});
  ASSERT_TRUE(path.ok()) << path.reason();
  EXPECT_EQ(alleys_of(*path), (std::vector<int>{0, 2, 4, 6, 8, 5, 3, 1, 7}));
}

TEST(Coverage, DrivesTheAlleysAsked) {
  const auto path =
      plan(make_narrow_map(), {{"alleys", std::vector<double>{1, 3, 2}}}, {{3.75, 0.0}, 0.5 * kPi});
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(alleys_of(*path), (std::vector<int>{1, 3, 2}));
}

TEST(Coverage, StraightensSurveyedLines) {
  RowMap map = make_narrow_map(1);
  map.alleys[0].line_W = {{1.25, 0, 0}, {1.26, 5, 0}, {1.245, 11, 0}, {1.25, 17, 0}};
  EXPECT_NEAR(plan(map, {})->length_m, 17.0, 1e-9);
  map.alleys[0].line_W[1].x() = 1.65;  // a true bend stays
  EXPECT_GT(plan(map, {})->length_m, 17.01);
}

/// A slope that ends at some y.
PlainScene make_slope(double end_y) {
  return PlainScene([end_y](double x, double y) {
    return y > end_y ? std::nullopt : std::optional(0.1 * x + 0.2 * y);
  });
}

Result<PlannedPath> plan_on(const PlainScene& slope) {
  const RowMap map = make_narrow_map(2);
  PlannerContext context;
  context.map = &map;
  context.scene = &slope;
  const VehicleDescription rover = make_rover_description();
  context.vehicle_description = &rover;
  return vinerow::controllers::make_coverage(make_parameters(controllers::coverage_spec(), {}),
                                             context)
      ->plan({quaternion_from_rpy({0, 0, 0.5 * kPi}), {1.25, 0, 0}});
}

TEST(Coverage, LiftsPointsOntoTheGround) {
  const auto path = plan_on(make_slope(100.0));
  ASSERT_TRUE(path.ok());
  for (const PathPoint& point : path->points) {
    EXPECT_NEAR(point.p_W.z(), 0.1 * point.p_W.x() + 0.2 * point.p_W.y(), 1e-12);
  }
}

TEST(Coverage, RefusesToLeaveTheGround) {
  const auto path = plan_on(make_slope(17.5));
  ASSERT_FALSE(path.ok());
  EXPECT_EQ(path.reason().find("path leaves the ground: no ground at ("), 0u) << path.reason();
}

TEST(Coverage, RefusesAPathIntoARow) {
  RowMap map = make_narrow_map(2);
  map.alleys[1].line_W[1].x() = 5.2;  // the second alley slants into row 2
  const auto path = plan(map, {});
  ASSERT_FALSE(path.ok());
  EXPECT_EQ(path.reason(),
            "path into a row: the turn passes (5.19, 17.33), 0.20 m from the centre line of row 2, "
            "whose canopy is 0.60 m wide");
}

TEST(Coverage, RefusesAStretchAcrossARowBetweenWaypoints) {
  RowMap map = make_narrow_map(2);
  map.alleys[1].line_W = {{4.0, 0.0, 0.0}, {6.0, 17.0, 0.0}};
  const auto path = plan(map, {{"waypoint_pitch_m", 30.0}, {"alleys", std::vector<double>{1}}},
                         {{4.0, 0.0}, 1.45});
  ASSERT_FALSE(path.ok());
  EXPECT_EQ(
      path.reason(),
      "path into a row: the leg in alley 1 passes (4.00, 0.00), 0.00 m from the centre line of "
      "row 2, whose canopy is 0.60 m wide");
}

TEST(Coverage, RefusesLessClearanceThanAsked) {
  const auto path = plan(make_narrow_map(2), {{"clearance_m", 1.0}});
  ASSERT_FALSE(path.ok());
  EXPECT_NE(path.reason().find("and needs a clearance of 1.00 m"), std::string::npos);
}

TEST(Coverage, RefusesAnArcTooTight) {
  const auto path = plan(make_narrow_map(3, 1.5), {});
  ASSERT_FALSE(path.ok());
  EXPECT_EQ(path.reason(),
            "turn from alley 0 to alley 1: the three-point arc between alleys 1.5 m apart has a "
            "radius of "
            "0.75 m, below turn_radius_m = 1 m; use turn: dubins, whose loop fits any spacing, or "
            "order: skip");
}

void expect_config_error(const RowMap& map, const PartChoice& choice, const std::string& text) {
  try {
    make_planner(choice, map);
    FAIL() << "must be refused: " << text;
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.what(), text);
  }
}

TEST(Coverage, RefusesAMapWithoutAlleysAndWrongAlleys) {
  expect_config_error(kNoRows, {"coverage", {}},
                      "rover.planner (coverage): the map has no alleys to drive");
  expect_config_error(
      make_narrow_map(), {"coverage", {{"alleys", std::vector<double>{0, 9}}}},
      "rover.planner (coverage): alleys holds 9, must be whole numbers from 0 to 8");
  expect_config_error(make_narrow_map(), {"coverage", {{"alleys", std::vector<double>{1.5}}}},
                      "rover.planner (coverage): alleys[0] = 1.5, must be a whole number");
  expect_config_error(make_narrow_map(), {"coverage", {{"alleys", std::vector<double>{2, 2}}}},
                      "rover.planner (coverage): alleys holds 2 twice");
}

TEST(Waypoints, SplitsStraightsBetweenThePoints) {
  const auto planner = make_planner({"waypoints",
                                     {{"x_m", std::vector<double>{0, 3, 3}},
                                      {"y_m", std::vector<double>{0, 0, 4}},
                                      {"waypoint_pitch_m", 0.5}}},
                                    kNoRows);
  const auto path = planner->plan(Pose{});
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(path->points.size(), 6u + 8u + 1u);
  EXPECT_DOUBLE_EQ(path->length_m, 7.0);
}

TEST(Waypoints, GoStraightThroughTheAirWhereTheyHaveHeights) {
  Values values = {{"x_m", std::vector<double>{0, 3, 3}},
                   {"y_m", std::vector<double>{0, 0, 4}},
                   {"z_m", std::vector<double>{50, 54, 54}}};
  // Above a row, which nothing on the ground may cross.
  const auto path = make_planner({"waypoints", values}, make_narrow_map(2))->plan(Pose{});
  ASSERT_TRUE(path.ok()) << path.reason();
  ASSERT_EQ(path->points.size(), 3u);
  EXPECT_DOUBLE_EQ(path->length_m, 5.0 + 4.0);
  EXPECT_EQ(path->points[1].p_W, Eigen::Vector3d(3, 0, 54));
  EXPECT_DOUBLE_EQ(path->points[1].yaw_rad, 0.5 * kPi);
  // A rotorcraft takes off to them.
  VehicleDescription drone;
  drone.type = "quadrotor";
  drone.rotorcraft.emplace();
  Pose start;
  start.p = {-4, 3, 20};
  const auto flight = make_planner({"waypoints", values}, make_narrow_map(2), &drone)->plan(start);
  ASSERT_TRUE(flight.ok()) << flight.reason();
  ASSERT_EQ(flight->points.size(), 5u);
  EXPECT_EQ(flight->points[0].p_W, start.p);
  EXPECT_EQ(flight->points[0].kind, PathKind::kVertical);
  EXPECT_EQ(flight->points[1].p_W, Eigen::Vector3d(-4, 3, 50));
  EXPECT_EQ(flight->points[2].p_W, Eigen::Vector3d(0, 0, 50));
  EXPECT_DOUBLE_EQ(flight->length_m, 30.0 + 5.0 + 5.0 + 4.0);
  // The ground there is at 0.1 x + 0.2 y; beyond it any height will do.
  const PlainScene slope = make_slope(3.5);
  PlannerContext context;
  context.scene = &slope;
  context.vehicle_description = &drone;
  values.back().second = std::vector<double>{0, 0.1, -9};
  const auto dive =
      controllers::make_waypoints(make_parameters(controllers::waypoints_spec(), values), context)
          ->plan(Pose{});
  ASSERT_FALSE(dive.ok());
  EXPECT_EQ(dive.reason(), "point 2 of 3 is 0.20 m below the ground: z_m = 0.1");
  values.back().second = std::vector<double>{50};
  expect_config_error(kNoRows, {"waypoints", values},
                      "rover.planner (waypoints): z_m has 1 numbers for 3 points, must be as many");
}

TEST(Waypoints, ReadsACsvFileAndNamesItsFaults) {
  const std::string file = ::testing::TempDir() + "waypoints.csv";
  std::ofstream(file) << "x,y\n0,0\n# a comment\n3,0\r\n3;4\n";
  const auto path = make_planner({"waypoints", {{"file", file}}}, kNoRows)->plan(Pose{});
  ASSERT_TRUE(path.ok());
  EXPECT_DOUBLE_EQ(path->length_m, 7.0);
  std::ofstream(file) << "0,0\n1,north\n";
  expect_config_error(kNoRows, {"waypoints", {{"file", file}}},
                      file + ":2: '1,north' must be two numbers, x and y in metres");
  expect_config_error(kNoRows, {"waypoints", {{"file", Text("/no/such.csv")}}},
                      "/no/such.csv: cannot be read");
  expect_config_error(kNoRows, {"waypoints", {{"file", file}, {"x_m", std::vector<double>{1}}}},
                      "rover.planner (waypoints): has both a file and x_m or y_m");
}

TEST(Waypoints, RefusesUnequalListsAndTooFewPoints) {
  expect_config_error(
      kNoRows, {"waypoints", {{"x_m", std::vector<double>{0, 1}}, {"y_m", std::vector<double>{0}}}},
      "rover.planner (waypoints): x_m has 2 numbers and y_m 1, must be as many");
  expect_config_error(
      kNoRows, {"waypoints", {}},
      "rover.planner (waypoints): needs at least two different points, from x_m and y_m or "
      "from a file");
}

TEST(Coverage, ARowOnTheWayFromTheStartIsRefusedWithTheRemedy) {
  const RowMap map = make_narrow_map(2);
  // In alley 1 instead of alley 0, where the route begins; row 1 at x = 2.5 is between them.
  const Values values = {{"alleys", std::vector<double>{0}}};
  const controllers::Pose2 start{{3.75, 8.0}, 0.5 * kPi};
  const auto path = plan(map, values, start);
  ASSERT_FALSE(path.ok());
  EXPECT_NE(path.reason().find("path into a row: the path passes"), std::string::npos);
  EXPECT_NE(path.reason().find(
                ", on the way to alley 0 from the estimated start (3.75, 8.00) heading 90.0 deg: "
                "start on the alley's line, estimate the start better, or leave the way to the "
                "follower by approach: false"),
            std::string::npos)
      << path.reason();
  Values without = values;
  without.push_back({"approach", false});
  EXPECT_TRUE(plan(map, without, start).ok());
}

TEST(Waypoints, RefusesAPathIntoARow) {
  const RowMap map = make_narrow_map(2);
  const Values values = {{"x_m", std::vector<double>{1, 4}}, {"y_m", std::vector<double>{5, 5}}};
  const auto path = make_planner({"waypoints", values}, map)->plan(Pose{});
  ASSERT_FALSE(path.ok());
  EXPECT_NE(path.reason().find("path into a row: the path passes"), std::string::npos);
}

/// Beside a canopy of 0.6 m the path's middle is free from 0.3 m on, a vehicle 1.2 m wide from 0.6.
TEST(Waypoints, RefusesAPathOnWhichTheVehicleHitsThePosts) {
  const RowMap map = make_narrow_map(2);
  VehicleDescription rover = make_rover_description();
  rover.footprint_B = {{-0.8, -0.6}, {0.8, -0.6}, {0.8, 0.6}, {-0.8, 0.6}};
  const auto plan_beside = [&](double distance_m) {
    const Values values = {{"x_m", std::vector<double>{distance_m, distance_m}},
                           {"y_m", std::vector<double>{2, 12}}};
    return make_planner({"waypoints", values}, map, &rover)->plan(Pose{});
  };
  EXPECT_TRUE(plan_beside(0.61).ok());
  const auto path = plan_beside(0.59);
  ASSERT_FALSE(path.ok());
  EXPECT_EQ(
      path.reason(),
      "path into a row: the path passes (0.59, 2.00), where the vehicle's outline touches row "
      "0");
  // Head on: its front is half of its length of 1.6 m ahead of its middle.
  const auto plan_towards = [&](double end_x_m) {
    const Values values = {{"x_m", std::vector<double>{-5, end_x_m}},
                           {"y_m", std::vector<double>{0.1, 0.1}}};
    return make_planner({"waypoints", values}, map, &rover)->plan(Pose{});
  };
  EXPECT_TRUE(plan_towards(-0.81).ok());
  EXPECT_FALSE(plan_towards(-0.79).ok());
}

}  // namespace
}  // namespace vinerow::test::coverage_test
