#include "controllers/planning/routes/route_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "controllers/planning/search/analytic_turn.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/block_map.h"
#include "tests/controllers/support/swept_check.h"
#include "tests/support/plain_scene.h"

namespace vinerow::test::route_planner_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Vec = Eigen::Vector2d;

constexpr double kRadius_m = 1.767;

/// Returns the shortest Dubins path, regardless of obstacles; records its queries.
class DubinsSearch final : public controllers::PoseSearch {
 public:
  struct Query {
    controllers::Pose2 from, to;
    int problem;
  };
  explicit DubinsSearch(std::vector<Query>* queries, bool fails = false)
      : queries_(queries), fails_(fails) {}

  Result<std::vector<controllers::PathSegment>> find(const controllers::Pose2& from,
                                                     const controllers::Pose2& to,
                                                     const controllers::Footprint&, int problem,
                                                     controllers::SearchReport& report) override {
    if (queries_ != nullptr) queries_->push_back({from, to, problem});
    report.nodes = 7;
    report.iterations = 11;
    report.tree_W = {from.p, to.p};
    if (fails_) return Failure{"no luck"};
    std::vector<controllers::PathSegment> pieces;
    controllers::append_dubins(from, controllers::calc_dubins(from, to, kRadius_m), PathKind::kTurn,
                               0.0, pieces);
    return pieces;
  }

 private:
  std::vector<Query>* queries_;
  bool fails_;
};

/// A block of 20 m rows and a planner on it.
struct Bench {
  explicit Bench(BlockSetup block = {.row_length_m = 20.0}) : setup(block), map(make_block(block)) {
    params.turning_radius_m = kRadius_m;
  }

  std::unique_ptr<Planner> make(bool fails = false) {
    PlannerContext context;
    context.part = "rover.planner";
    context.map = &map;
    context.vehicle_description = &vehicle;
    context.scene = scene;
    return controllers::make_route_planner(params, std::make_unique<DubinsSearch>(&queries, fails),
                                           context);
  }
  Result<PlannedPath> plan(double x, double y, double yaw_rad, bool fails = false) {
    planner = make(fails);
    const Vec p = block_point(setup, x, y);
    return planner->plan(
        {quaternion_from_rpy({0, 0, yaw_rad + setup.turned_rad}), {p.x(), p.y(), 0.4}});
  }
  double number(const char* name) { return planner->report()->numbers.at(name); }

  BlockSetup setup;
  RowMap map;
  VehicleDescription vehicle = make_four_wheel_description(kRadius_m);
  controllers::RoutePlannerParams params;
  const SceneQuery* scene = nullptr;
  std::vector<DubinsSearch::Query> queries;
  std::unique_ptr<Planner> planner;
};

/// Length of the loop between alleys `d` apart: a right of acos((d/2 + R) / 2R), a left of half a
/// turn and twice as much, and the right again.
double loop_length_m(double d, double radius_m) {
  return radius_m * (kPi + 4.0 * std::acos((0.5 * d + radius_m) / (2.0 * radius_m)));
}

TEST(RoutePlanner, DrivesLegsAndTurns) {
  Bench bench({.alleys = 3, .row_length_m = 20.0});
  const auto path = bench.plan(1.25, -1.0, 0.5 * kPi);
  ASSERT_TRUE(path.ok()) << path.reason();
  const double turn_m = loop_length_m(2.5, kRadius_m);
  EXPECT_NEAR(path->length_m, 1.0 + 3 * 20.0 + 2 * turn_m, 1e-9);
  EXPECT_NEAR(bench.number("length_m"), path->length_m, 1e-9);
  EXPECT_NEAR(bench.number("turn_length_m"), 2 * turn_m, 1e-9);
  EXPECT_EQ(bench.number("turns"), 2.0);
  EXPECT_EQ(bench.number("nodes"), 14.0);
  EXPECT_EQ(bench.number("iterations"), 22.0);

  std::vector<std::pair<PathKind, int>> stretches;
  for (const PathPoint& point : path->points) {
    const std::pair<PathKind, int> now{point.kind, point.alley};
    if (stretches.empty() || stretches.back() != now) stretches.push_back(now);
  }
  const std::vector<std::pair<PathKind, int>> expected = {
      {PathKind::kTransit, -1}, {PathKind::kLeg, 0},   {PathKind::kTurn, -1},
      {PathKind::kLeg, 1},      {PathKind::kTurn, -1}, {PathKind::kLeg, 2}};
  EXPECT_EQ(stretches, expected);

  ASSERT_EQ(bench.queries.size(), 2u);
  EXPECT_EQ(bench.queries[0].problem, 1);
  EXPECT_EQ(bench.queries[1].problem, 2);
  EXPECT_NEAR((bench.queries[0].from.p - Vec(1.25, 20.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((bench.queries[1].to.p - Vec(6.25, 0.0)).norm(), 0.0, 1e-12);

  const SweptVerdict verdict =
      check_swept(*path, bench.vehicle.footprint_B, bench.map.occupancy, 0.1);
  EXPECT_EQ(verdict.fault, "");
  EXPECT_NEAR(verdict.length_m, path->length_m, 1e-6);
  EXPECT_NEAR(bench.number("clearance_m"), verdict.min_m, bench.setup.cell_m);
  EXPECT_EQ(bench.number("clearance_m"), bench.number("turn_clearance_m"));
  EXPECT_GT(verdict.min_m, 0.0);
}

TEST(RoutePlanner, LegsGoOnBeyondTheRowEnds) {
  Bench bench({.alleys = 3, .row_length_m = 20.0});
  bench.params.route.beyond_m = 1.5;
  const auto path = bench.plan(1.25, -1.0, 0.5 * kPi);
  ASSERT_TRUE(path.ok()) << path.reason();
  EXPECT_NEAR(path->length_m, 1.0 + 3 * 20.0 + 4 * 1.5 + 2 * loop_length_m(2.5, kRadius_m), 1e-9);
  EXPECT_NEAR(bench.queries[0].from.p.y(), 21.5, 1e-12);
  EXPECT_NEAR(path->points.back().p_W.y(), 20.0, 1e-9);  // the last leg ends with its row
}

TEST(RoutePlanner, SpeedsAreOfLegsAndTurns) {
  Bench bench;
  bench.params.speed_mps = 0.9;
  bench.params.turn_speed_mps = 0.4;
  const auto path = bench.plan(1.25, 0.0, 0.5 * kPi);
  ASSERT_TRUE(path.ok()) << path.reason();
  for (const PathPoint& point : path->points) {
    EXPECT_EQ(point.speed_mps, point.kind == PathKind::kTurn ? 0.4 : 0.9);
  }
}

TEST(RoutePlanner, BeginsWhereTheVehicleStandsOnTheLeg) {
  Bench bench;
  const auto path = bench.plan(1.27, 6.0, 0.5 * kPi + 0.02);
  ASSERT_TRUE(path.ok()) << path.reason();
  EXPECT_NEAR(path->length_m, 2 * 20.0 - 6.0 + loop_length_m(2.5, kRadius_m), 1e-9);
  EXPECT_EQ(path->points.front().kind, PathKind::kLeg);
  EXPECT_NEAR(path->points.front().p_W.y(), 6.0, 1e-9);
}

TEST(RoutePlanner, MergesFromALittleAside) {
  for (const double aside_m : {-0.3, 0.3}) {
    Bench bench;
    const auto path = bench.plan(1.25 + aside_m, -2.0, 0.5 * kPi + 0.1);
    ASSERT_TRUE(path.ok()) << path.reason();
    EXPECT_EQ(bench.queries.size(), 1u);  // for the turn only
    EXPECT_EQ(path->points.front().kind, PathKind::kTransit);
    EXPECT_NEAR((path->points.front().p_W.head<2>() - Vec(1.25 + aside_m, -2.0)).norm(), 0, 1e-9);
    const SweptVerdict verdict =
        check_swept(*path, bench.vehicle.footprint_B, bench.map.occupancy, 0.1);
    EXPECT_EQ(verdict.fault, "");
    EXPECT_LE(verdict.sharpest_per_m, 1.0 / kRadius_m + 1e-9);
    EXPECT_LT(path->length_m, 2.05 + 2 * 20.0 + loop_length_m(2.5, kRadius_m));
  }
}

TEST(RoutePlanner, SearchesTheWayFromElsewhere) {
  Bench bench;
  const auto path = bench.plan(-1.0, -7.0, kPi);
  ASSERT_EQ(bench.queries.size(), 2u);
  EXPECT_EQ(bench.queries[0].problem, 0);
  ASSERT_TRUE(path.ok()) << path.reason();
  EXPECT_EQ(path->points.front().kind, PathKind::kTransit);
  EXPECT_EQ(bench.number("turns"), 1.0);
}

TEST(RoutePlanner, LiftsPathAndTreeOntoTheGround) {
  const PlainScene hill(GroundPlane{.rise_x = 0.15, .rise_y = 0.02, .z_m = 5.0});
  Bench bench;
  bench.scene = &hill;
  const auto path = bench.plan(1.25, -1.0, 0.5 * kPi);
  ASSERT_TRUE(path.ok()) << path.reason();
  for (const PathPoint& point : path->points) {
    EXPECT_NEAR(point.p_W.z(), hill.ground_m(point.p_W.head<2>()), 1e-12);
  }
  const auto& tree = bench.planner->report()->tree.points_W;
  ASSERT_EQ(tree.size(), 2u);
  for (const Eigen::Vector3d& p : tree) {
    EXPECT_NEAR(p.z(), hill.ground_m(p.head<2>()), 1e-12);
  }
}

TEST(RoutePlanner, RefusesAMapWithoutGridOrAlleys) {
  Bench bench;
  bench.map.occupancy = {};
  EXPECT_THAT([&] { bench.make(); },
              ::testing::ThrowsMessage<ConfigError>(
                  HasSubstr("rover.planner: the map has no occupancy grid: set occupancy_cell_m")));
  bench.map.alleys.clear();
  EXPECT_THAT([&] { bench.make(); },
              ::testing::ThrowsMessage<ConfigError>(HasSubstr("the map has no alleys to drive")));
}

TEST(RoutePlanner, RefusesAStartInCollision) {
  Bench bench;
  const auto in_row = bench.plan(2.5, 10.0, 0.5 * kPi);
  ASSERT_FALSE(in_row.ok());
  EXPECT_EQ(in_row.reason(),
            "start in collision: (2.50, 10.00) heading 90.0 deg is in a row: 0.00 m from the "
            "centre line of row 1, whose canopy is 0.60 m wide");
  const auto at_canopy = bench.plan(1.85, 10.0, 0.5 * kPi);
  ASSERT_FALSE(at_canopy.ok());
  EXPECT_EQ(at_canopy.reason(),
            "start in collision: at (1.85, 10.00) heading 90.0 deg the footprint has 0.000 m of "
            "clearance, the margin is 0.050 m");
  const auto outside = bench.plan(1.25, -40.0, 0.5 * kPi);
  ASSERT_FALSE(outside.ok());
  EXPECT_EQ(outside.reason(),
            "start in collision: (1.25, -40.00) heading 90.0 deg is outside the map's occupancy "
            "grid");
  EXPECT_EQ(bench.number("nodes"), 0.0);
}

TEST(RoutePlanner, RefusesGoalsAndLegsInRows) {
  Bench bench;
  bench.map.alleys[1].line_W[1].x() = 4.9;  // the exit of alley 1 at its far end, in row 2
  const auto goal = bench.plan(1.25, -1.0, 0.5 * kPi);
  ASSERT_FALSE(goal.ok());
  EXPECT_THAT(goal.reason(), StartsWith("entrance of alley 1 blocked: (4.90, 20.00) heading"));
  EXPECT_THAT(goal.reason(), HasSubstr("is in a row: 0.10 m from the centre line of row 2, whose "
                                       "canopy is 0.60 m wide"));

  Bench blocked;
  mark(blocked.map.occupancy, {1.0, 12.0}, {1.4, 12.0}, 0.1);
  const auto leg = blocked.plan(1.25, -1.0, 0.5 * kPi);
  ASSERT_FALSE(leg.ok());
  EXPECT_THAT(leg.reason(), StartsWith("the leg in alley 0 is blocked: at (1.25, 10."));
  EXPECT_THAT(leg.reason(), HasSubstr("m of clearance, the margin is 0.050 m"));
}

TEST(RoutePlanner, TellsTheRoomThatATurnLacks) {
  Bench bench;
  bench.params.turning_radius_m = 2.6;
  const auto path = bench.plan(1.25, -1.0, 0.5 * kPi, true);
  ASSERT_FALSE(path.ok());
  EXPECT_THAT(
      path.reason(),
      ::testing::MatchesRegex("the turn from alley 0 to alley 1 needs 0\\.7. m more clearance at "
                              "the turning radius of 2\\.60 m \\(footprint 1\\.9 x 1\\.0 m, "
                              "margin 0\\.05 m\\): no luck"));
  EXPECT_EQ(bench.number("nodes"), 7.0);  // reported also after a failure
  EXPECT_EQ(bench.planner->report()->tree.points_W.size(), 2u);
  // Turns that leave the surroundings are not measured.
  bench.params.turning_radius_m = 1e6;
  EXPECT_THAT(bench.plan(1.25, -1.0, 0.5 * kPi, true).reason(),
              StartsWith("the turn from alley 0 to alley 1 needs at least 10.05 m more clearance"));
}

TEST(RoutePlanner, TellsWhereASearchFailsThoughThereIsRoom) {
  Bench bench;
  const auto turn = bench.plan(1.25, -1.0, 0.5 * kPi, true);
  ASSERT_FALSE(turn.ok());
  EXPECT_EQ(turn.reason(), "no turn from alley 0 to alley 1 found: no luck");
  const auto approach = bench.plan(-1.0, -7.0, kPi, true);
  ASSERT_FALSE(approach.ok());
  EXPECT_EQ(
      approach.reason(),
      "no path from the start at (-1.00, -7.00) heading 180.0 deg to the entrance of alley 0 at "
      "(1.25, 0.00) heading 90.0 deg: no luck");
  // A wall across the headland: no ground joins the alleys at all.
  mark(bench.map.occupancy, {2.5, 20.0}, {2.5, 30.0}, 0.0);
  const auto walled = bench.plan(1.25, -1.0, 0.5 * kPi, true);
  ASSERT_FALSE(walled.ok());
  EXPECT_EQ(
      walled.reason(),
      "no free ground connects alley 0 at (1.25, 20.00) heading 90.0 deg and alley 1 at (3.75, "
      "20.00) heading -90.0 deg: no luck");
}

TEST(RoutePlanner, MissingClearanceIsThatOfTheLoopBetweenWalls) {
  // The hull's outer front corner goes round at the middle of the loop, which lies between the
  // walls 2.5 m to either side; cells that the wall touches reach up to a cell nearer.
  for (const double radius_m : {1.9, 2.2, 2.6, 3.2}) {
    const Bench bench;
    const controllers::DistanceField field(bench.map.occupancy);
    const controllers::Pose2 from{{1.25, 20.0}, 0.5 * kPi}, to{{3.75, 20.0}, -0.5 * kPi};
    const auto missing_m = controllers::calc_missing_clearance_m(from, to, radius_m, field,
                                                                 bench.vehicle.footprint_B, 0.05);
    ASSERT_TRUE(missing_m.has_value());
    const double expected_m = std::hypot(radius_m + 0.5, 0.75) + 0.05 - 2.5;
    EXPECT_GE(*missing_m, expected_m - 0.01) << radius_m;
    EXPECT_LE(*missing_m, expected_m + 1.5 * bench.setup.cell_m) << radius_m;
  }
}

TEST(RoutePlanner, NothingIsMissingWhereTheTurnFits) {
  const Bench bench;
  const controllers::DistanceField field(bench.map.occupancy);
  const controllers::Pose2 from{{1.25, 20.0}, 0.5 * kPi}, to{{3.75, 20.0}, -0.5 * kPi};
  EXPECT_EQ(controllers::calc_missing_clearance_m(from, to, 1.767, field, bench.vehicle.footprint_B,
                                                  0.02),
            0.0);
  // However long the turn is: 60,000 km here.
  EXPECT_DOUBLE_EQ(
      *controllers::calc_missing_clearance_m(from, to, 1e7, field, bench.vehicle.footprint_B, 0.05),
      10.05);
  EXPECT_EQ(controllers::calc_missing_clearance_m(from, to, 1.767, controllers::DistanceField{},
                                                  bench.vehicle.footprint_B, 0.05),
            0.0);
  const controllers::Pose2 in_row{{2.5, 10.0}, 0.5 * kPi};
  EXPECT_EQ(controllers::calc_missing_clearance_m(from, in_row, 1.767, field,
                                                  bench.vehicle.footprint_B, 0.05),
            std::nullopt);
}

ParameterSet make_parameters() {
  return ParameterSet(controllers::route_planner_table().specs(), "planner");
}

TEST(RoutePlannerParameters, TurningRadiusIsTheVehiclesOrWider) {
  const Bench bench;
  VehicleDescription vehicle = bench.vehicle;
  PlannerContext context;
  context.map = &bench.map;
  context.vehicle_description = &vehicle;
  EXPECT_EQ(
      controllers::read_route_planner_params(make_parameters(), context, "me").turning_radius_m,
      1.767);
  ParameterSet wider = make_parameters();
  wider.set("turning_radius_m", 2.0);
  EXPECT_EQ(controllers::read_route_planner_params(wider, context, "me").turning_radius_m, 2.0);
  ParameterSet tighter = make_parameters();
  tighter.set("turning_radius_m", 1.5);
  EXPECT_THAT([&] { controllers::read_route_planner_params(tighter, context, "me"); },
              ::testing::ThrowsMessage<ConfigError>(
                  "me: turning_radius_m = 1.500 m is less than the 1.767 m that vehicle type "
                  "'four_wheel_steering_rover' can turn"));
  vehicle.min_turning_radius_m = 0.0;
  EXPECT_THAT([&] { controllers::read_route_planner_params(make_parameters(), context, "me"); },
              ::testing::ThrowsMessage<ConfigError>(HasSubstr("give turning_radius_m")));
  vehicle.min_turning_radius_m.reset();
  EXPECT_THAT(
      [&] { controllers::read_route_planner_params(make_parameters(), context, "me"); },
      ::testing::ThrowsMessage<ConfigError>("me needs 'min_turning_radius_m', which vehicle type "
                                            "'four_wheel_steering_rover' does not have"));
}

TEST(AnalyticTurn, EveryCandidateArrivesAndTheyAreSorted) {
  const controllers::Pose2 from{{0, 0}, 0.3}, to{{2.5, 0.7}, 0.3 + kPi};
  const auto turns = controllers::make_analytic_turns(from, to, {1.5, 2.0, 0.5});
  EXPECT_GT(turns.size(), 100u);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    ASSERT_GE(turns[i].length_m, turns[i > 0 ? i - 1 : 0].length_m - 1.1e-3);
    const auto pieces = controllers::make_pieces(from, to, turns[i]);
    ASSERT_NEAR(controllers::calc_length_m(pieces), turns[i].length_m, 1e-5);
    controllers::Pose2 at = from;
    for (const controllers::PathSegment& piece : pieces) {
      ASSERT_NEAR((piece.start.p - at.p).norm(), 0.0, 1e-6);
      ASSERT_NEAR(wrap_angle(piece.start.yaw_rad - at.yaw_rad), 0.0, 1e-6);
      ASSERT_LE(std::abs(piece.curvature_per_m), 1.0 / 1.5 + 1e-12);
      at = piece.end();
    }
    ASSERT_NEAR((at.p - to.p).norm(), 0.0, 1e-6);
    ASSERT_NEAR(wrap_angle(at.yaw_rad - to.yaw_rad), 0.0, 1e-6);
  }
  EXPECT_NEAR(turns.front().length_m, controllers::calc_dubins(from, to, 1.5).length_m(), 1e-9);
}

}  // namespace
}  // namespace vinerow::test::route_planner_test
