// What stands in an alley is driven around where there is room, and from place to place around all
// that the map has. Judged by polygons against the grid's squares.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "controllers/parts/paths/footprint.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/block_map.h"
#include "tests/controllers/support/mission.h"
#include "tests/controllers/support/swept_check.h"

namespace vinerow::test::obstacle_ways_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Vec = Eigen::Vector2d;

struct Yard {
  explicit Yard(const BlockSetup& block) : map(make_block(block)) {}

  Result<PlannedPath> plan(const PartChoice& choice, double x, double y, double yaw_rad) {
    planner = make_planner(choice, map, &vehicle);
    return planner->plan({quaternion_from_rpy({0, 0, yaw_rad}), {x, y, 0.0}});
  }
  double number(const char* name) const { return planner->report()->numbers.at(name); }

  RowMap map;
  VehicleDescription vehicle = make_four_wheel_description();
  std::unique_ptr<Planner> planner;
};

TEST(ObstacleWays, DrivesAroundACrateInAnAlley) {
  for (const char* type : {"rrt_quartile", "rrt_star"}) {
    Yard yard({.row_length_m = 40.0});
    // A crate of 0.5 m at the left canopy, 1.3 m left of it: the middle of the alley is blocked.
    mark(yard.map.occupancy, {0.55, 20.0}, {0.55, 20.5}, 0.25);
    const auto path = yard.plan({type, {}}, 1.25, -1.0, 0.5 * kPi);
    ASSERT_TRUE(path.ok()) << type << ": " << path.reason();
    EXPECT_EQ(yard.number("legs_with_detours"), 1.0);
    const SweptVerdict verdict =
        check_swept(*path, yard.vehicle.outline_B(), yard.map.occupancy, 0.01);
    EXPECT_EQ(verdict.fault, "") << type;
    EXPECT_GT(verdict.min_m, 0.03) << type;
    EXPECT_LE(verdict.sharpest_per_m, 1.0 / 1.767 + 1e-6) << type;
    // 0.3 m aside and back takes centimetres; a loop would take metres.
    Yard free({.row_length_m = 40.0});
    const auto straight = free.plan({type, {}}, 1.25, -1.0, 0.5 * kPi);
    ASSERT_TRUE(straight.ok());
    EXPECT_LT(path->length_m, straight->length_m + 1.0) << type;
  }
}

TEST(ObstacleWays, TellsWhatLeavesNoRoom) {
  Yard yard({.row_length_m = 40.0});
  mark(yard.map.occupancy, {1.0, 20.0}, {1.5, 20.0}, 0.25);
  const auto path = yard.plan({"rrt_quartile", {}}, 1.25, -1.0, 0.5 * kPi);
  ASSERT_FALSE(path.ok());
  EXPECT_THAT(path.reason(), StartsWith("the leg in alley 0 is blocked: at (1.25, "));
  EXPECT_THAT(path.reason(), HasSubstr("; no path around it: "));
}

TEST(ObstacleWays, APlaceWhereTheVehicleIsNeedsNoWay) {
  Yard yard({.row_length_m = 30.0});
  const auto go_to = [](std::vector<double> x_m, std::vector<double> y_m) {
    return PartChoice{"go_to", {{"x_m", std::move(x_m)}, {"y_m", std::move(y_m)}}};
  };
  const auto once = yard.plan(go_to({1.25}, {28.0}), 1.25, -3.0, 0.5 * kPi);
  ASSERT_TRUE(once.ok()) << once.reason();
  for (const auto& choice :
       {go_to({1.25, 1.25}, {28.0, 28.0}), go_to({1.25, 1.25}, {-3.0, 28.0})}) {
    const auto path = yard.plan(choice, 1.25, -3.0, 0.5 * kPi);
    ASSERT_TRUE(path.ok()) << path.reason();
    EXPECT_DOUBLE_EQ(path->length_m, once->length_m);
  }
  EXPECT_EQ(yard.plan(go_to({1.25}, {-3.0}), 1.25, -3.0, 0.5 * kPi).reason(),
            "the vehicle is at the place already");
  // Another heading there takes a loop.
  PartChoice turned = go_to({1.25}, {-3.0});
  turned.values.emplace_back("end_bearing_deg", 180.0);
  const auto loop = yard.plan(turned, 1.25, -3.0, 0.5 * kPi);
  ASSERT_TRUE(loop.ok()) << loop.reason();
  EXPECT_GT(loop->length_m, 5.0);
}

TEST(ObstacleWays, GoesFromPlaceToPlaceThroughTheBlock) {
  for (const bool has_crate : {false, true}) {
    Yard yard({.alleys = 3, .row_length_m = 30.0, .has_walls = false});
    if (has_crate) mark(yard.map.occupancy, {0.55, 15.0}, {0.55, 15.5}, 0.25);
    // Out of the first alley's mouth, through it, round its end and down the third.
    const PartChoice choice{"go_to",
                            {{"x_m", std::vector<double>{1.25, 6.25}},
                             {"y_m", std::vector<double>{28.0, 2.0}},
                             {"end_bearing_deg", 180.0}}};
    const auto path = yard.plan(choice, 1.25, -3.0, 0.5 * kPi);
    ASSERT_TRUE(path.ok()) << path.reason();
    const SweptVerdict verdict =
        check_swept(*path, yard.vehicle.outline_B(), yard.map.occupancy, 0.01);
    EXPECT_EQ(verdict.fault, "");
    EXPECT_GT(verdict.min_m, 0.03);
    EXPECT_LE(verdict.sharpest_per_m, 1.0 / 1.767 + 1e-6);
    const PathPoint& end = path->points.back();
    EXPECT_LT((end.p_W.head<2>() - Vec(6.25, 2.0)).norm(), 1e-6);
    EXPECT_NEAR(wrap_angle(end.yaw_rad + 0.5 * kPi), 0.0, 1e-6);  // southwards
    // At least the straight ways; a way through the neighbouring alley as well would be 50 m more.
    EXPECT_GT(path->length_m, 31.0 + 26.0);
    EXPECT_LT(path->length_m, 31.0 + 26.0 + 25.0);
  }
}

TEST(ObstacleWays, GoesStraightWhereNothingIsInTheWay) {
  Yard yard({.row_length_m = 30.0});
  const PartChoice choice{"go_to",
                          {{"x_m", std::vector<double>{1.25}}, {"y_m", std::vector<double>{25.0}}}};
  const auto path = yard.plan(choice, 1.25, -2.0, 0.5 * kPi);
  ASSERT_TRUE(path.ok()) << path.reason();
  EXPECT_NEAR(path->length_m, 27.0, 1e-9);
  EXPECT_EQ(path->points.back().curvature_per_m, 0.0);
}

TEST(ObstacleWays, RefusesPlacesInRowsAndMapsWithoutGrid) {
  Yard yard({.row_length_m = 30.0});
  const auto at = [](double x, double y) {
    return PartChoice{"go_to", {{"x_m", std::vector<double>{x}}, {"y_m", std::vector<double>{y}}}};
  };
  const auto into_a_row = yard.plan(at(2.5, 10.0), 1.25, -2.0, 0.5 * kPi);
  ASSERT_FALSE(into_a_row.ok());
  EXPECT_THAT(into_a_row.reason(), HasSubstr("goal in collision: at (2.50, 10.00)"));
  yard.map.occupancy = {};
  try {
    static_cast<void>(yard.plan(at(1.25, 10.0), 1.25, -2.0, 0.5 * kPi));
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.planner (go_to): the map has no occupancy grid: set occupancy_cell_m");
  }
}

TEST(Footprint, SeesWhatPassesBetweenTwoPoses) {
  // A square of 1 m turns about itself past a corner that only its own corner reaches, half way
  // between two poses that are both free.
  OccupancyGrid grid;
  grid.columns = grid.rows = 200;
  grid.cell_m = 0.02;
  grid.corner_W = {-2.0, -2.0};
  grid.cells.assign(200 * 200, 0);
  mark(grid, {0.01, 0.67}, {0.01, 0.9}, 0.001);
  const controllers::DistanceField field(grid);
  const controllers::Footprint footprint(field,
                                         {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, 0.0);
  // On a circle of 1 cm radius: half a turn in 3 cm.
  const controllers::Pose2 start{{0.0, -0.01}, 0.0};
  const double curvature_per_m = 100.0, quarter_m = 0.5 * kPi / curvature_per_m;
  ASSERT_TRUE(footprint.is_free(start));
  ASSERT_TRUE(footprint.is_free(controllers::advance(start, quarter_m, 0.5 * kPi)));
  ASSERT_FALSE(footprint.is_free(controllers::advance(start, 0.5 * quarter_m, 0.25 * kPi)));
  EXPECT_FALSE(footprint.is_free_along(start, quarter_m, curvature_per_m, 0.1));
}

}  // namespace
}  // namespace vinerow::test::obstacle_ways_test
