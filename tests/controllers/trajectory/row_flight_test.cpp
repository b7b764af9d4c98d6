// Planner `row_flight`: heights, order, lengths, refusals.

#include "controllers/planning/flight/row_flight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/swept_check.h"
#include "tests/controllers/trajectory/flight_world.h"

namespace vinerow::test::row_flight_test {
namespace {

using ::testing::HasSubstr;
using Vec = Eigen::Vector2d;

constexpr double kRadius_m = 1.77;

/// The loop between alleys `d` apart: a right of acos((d/2 + R) / 2R), a left of half a turn and
/// twice as much, and the right again.
double loop_length_m(double d) {
  return kRadius_m * (kPi + 4.0 * std::acos((0.5 * d + kRadius_m) / (2.0 * kRadius_m)));
}

std::vector<std::pair<PathKind, int>> stretches_of(const PlannedPath& plan) {
  std::vector<std::pair<PathKind, int>> stretches;
  for (const PathPoint& point : plan.points) {
    const std::pair<PathKind, int> now{point.kind, point.alley};
    if (stretches.empty() || stretches.back() != now) stretches.push_back(now);
  }
  return stretches;
}

TEST(RowFlight, FliesUpAlongTheRowsHomeAndDown) {
  for (const double turned_rad : {0.0, 0.7}) {
    FlightBench bench({.alleys = 3, .turned_rad = turned_rad});
    bench.values = {{"turns", std::string("dubins")}};
    const auto plan = bench.plan(1.25, -5.0);
    ASSERT_TRUE(plan.ok()) << plan.reason();
    const std::vector<std::pair<PathKind, int>> expected = {
        {PathKind::kVertical, -1}, {PathKind::kTransit, -1}, {PathKind::kLeg, 0},
        {PathKind::kTurn, -1},     {PathKind::kLeg, 1},      {PathKind::kTurn, -1},
        {PathKind::kLeg, 2},       {PathKind::kReturn, -1},  {PathKind::kVertical, -1}};
    EXPECT_EQ(stretches_of(*plan), expected);
    const Vec home = block_point(bench.setup, 1.25, -5.0),
              exit = block_point(bench.setup, 6.25, 118.0);
    EXPECT_NEAR((plan->points.front().p_W - Eigen::Vector3d(home.x(), home.y(), 0.2)).norm(), 0.0,
                1e-9);
    EXPECT_NEAR((plan->points.back().p_W - Eigen::Vector3d(home.x(), home.y(), 0.2)).norm(), 0.0,
                1e-9);
    double plane_m = 0.0, legs_m = 0.0;
    const std::vector<PlanSample> samples = sample_plan(*plan, 0.01);
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const double step_m = (samples[i].p_W - samples[i - 1].p_W).head<2>().norm();
      plane_m += step_m;
      if (samples[i - 1].kind == PathKind::kLeg) {
        legs_m += step_m;
        ASSERT_NEAR(samples[i].p_W.z(), 1.5, 1e-9);
      }
    }
    EXPECT_NEAR(legs_m, 3 * 118.0, 1e-6);
    EXPECT_NEAR(plane_m, 5.0 + 3 * 118.0 + 2 * loop_length_m(2.5) + (exit - home).norm(), 1e-3);
    EXPECT_EQ(bench.number("turns"), 2.0);
    EXPECT_NEAR(bench.number("turn_length_m"), 2 * loop_length_m(2.5), 1e-9);
    EXPECT_NEAR(bench.number("return_length_m"), (exit - home).norm(), 1e-9);
    EXPECT_EQ(bench.number("length_m"), plan->length_m);
    EXPECT_NEAR(bench.number("row_height_error_m"), 0.0, 1e-12);
  }
}

TEST(RowFlight, LengthAndClimbOverFlatOpenGroundAreThoseOfStraights) {
  // One alley, flown to its far end: the way home leads along its middle, 0.95 m from the canopies.
  FlightBench bench({.alleys = 1}, make_flat(7.0));
  bench.values = {{"turns", std::string("dubins")}};
  const auto plan = bench.plan(1.25, -5.0);
  ASSERT_TRUE(plan.ok()) << plan.reason();
  EXPECT_NEAR(plan->length_m, 1.3 + 5.0 + 118.0 + 1.5 + 123.0 + 2.8, 1e-9);
  EXPECT_NEAR(bench.number("climb_m"), 1.3 + 1.5, 1e-9);
  EXPECT_NEAR(bench.number("return_clearance_m"), 3.0, 1e-9);
  for (const PlanSample& sample : sample_plan(*plan, 0.1)) {
    if (sample.kind == PathKind::kLeg) {
      EXPECT_NEAR(sample.p_W.z(), 8.5, 1e-9);
    }
  }
}

TEST(RowFlight, KeepsItsHeightAboveASlopeWithBumps) {
  FlightBench bench({.alleys = 4}, make_bumpy_slope());
  bench.values = {{"turns", std::string("dubins")}};
  const auto plan = bench.plan(1.25, -6.0);
  ASSERT_TRUE(plan.ok()) << plan.reason();
  double worst_m = 0.0;
  for (const PlanSample& sample : sample_plan(*plan, 0.1)) {
    if (sample.kind != PathKind::kLeg && sample.kind != PathKind::kTurn) continue;
    const double above_m = sample.p_W.z() - bench.hill.ground_m(sample.p_W.head<2>());
    worst_m = std::max(worst_m, std::abs(above_m - 1.5));
  }
  RecordProperty("worst_mm", static_cast<int>(1e3 * worst_m));
  EXPECT_LT(worst_m, 0.03);
  EXPECT_LT(bench.number("row_height_error_m"), 0.03);
  EXPECT_GT(bench.number("row_height_error_m"), 0.001);  // crests are smoothed
}

TEST(RowFlight, SmoothsRoughGround) {
  // Steps of 0.2 m every 2 m: at 3 m/s the raw heights would jump.
  FlightBench bench({.alleys = 1}, PlainScene([](double, double y) {
                      return 0.2 *
                             (static_cast<int>(std::floor((y - 1.0) / 2.0)) % 2 == 0 ? 1.0 : 0.0);
                    }));
  bench.values = {{"turns", std::string("dubins")}};
  const auto plan = bench.plan(1.25, -5.0);
  ASSERT_TRUE(plan.ok()) << plan.reason();
  double steepest = 0.0;
  for (std::size_t i = 1; i < plan->points.size(); ++i) {
    const PathPoint &a = plan->points[i - 1], &b = plan->points[i];
    if (a.kind != PathKind::kLeg) continue;
    const double run_m = (b.p_W - a.p_W).head<2>().norm();
    steepest = std::max(steepest, std::abs(b.p_W.z() - a.p_W.z()) / run_m);
  }
  // Two averages over 1 m of a step of 0.2 m: 0.2 m over 1 m where the first average has begun.
  EXPECT_LT(steepest, 0.21);
}

TEST(RowFlight, RefusesToSmoothHillsAway) {
  FlightBench bench({.alleys = 1}, PlainScene([](double, double y) {
                      return 5.0 * std::exp(-0.02 * (y - 20.0) * (y - 20.0));
                    }));
  bench.values = {{"turns", std::string("dubins")}, {"smooth_m", 50.0}};
  const auto plan = bench.plan(1.25, -5.0);
  ASSERT_FALSE(plan.ok());
  EXPECT_THAT(plan.reason(), HasSubstr("with heights smoothed over smooth_m = 50 m the vehicle "
                                       "would be "));
  EXPECT_THAT(plan.reason(), HasSubstr(" m in the ground at (1.25, "));
  bench.values.back().second = 2.0;
  EXPECT_TRUE(bench.plan(1.25, -5.0).ok());
  // Its legs are 0.2 m long: a flight of 0.21 m has 1 cm to spare above bumps of 0.1 m.
  FlightBench low({.alleys = 1},
                  PlainScene([](double, double y) { return 0.05 * std::sin(2.0 * y); }));
  low.values = {{"turns", std::string("dubins")}, {"height_m", 0.21}, {"smooth_m", 4.0}};
  const auto scraping = low.plan(1.25, -5.0);
  ASSERT_FALSE(scraping.ok());
  EXPECT_THAT(scraping.reason(), HasSubstr("smooth_m = 4 m the vehicle would be "));
}

/// Heights above ground and canopies along the way home, canopies as boxes on the rows' lines.
TEST(RowFlight, GoesHomeAboveGroundAndCanopies) {
  for (const int alleys : {3, 7, 15}) {
    FlightBench bench({.alleys = alleys}, make_bumpy_slope());
    bench.values = {{"turns", std::string("dubins")}};
    const auto plan = bench.plan(1.25, -6.0);
    ASSERT_TRUE(plan.ok()) << plan.reason();
    const Vec exit = block_point(bench.setup, 2.5 * alleys - 1.25, 118.0);
    double min_m = 1e9, highest_m = 0.0;
    bool over_rows = false;
    for (const PlanSample& sample : sample_plan(*plan, 0.1)) {
      const Vec p = sample.p_W.head<2>();
      if (sample.kind != PathKind::kReturn || (p - exit).norm() < 1e-6) continue;
      const double row_x = 2.5 * std::round(p.x() / 2.5);
      const bool over = p.y() >= 0.0 && p.y() <= 118.0 && std::abs(p.x() - row_x) <= 0.3;
      over_rows = over_rows || over;
      double below_m = bench.hill.ground_m(p);
      if (over) below_m = std::max(below_m, bench.hill.ground_m({row_x, p.y()})) + 2.0;
      min_m = std::min(min_m, sample.p_W.z() - below_m);
      if (!over) highest_m = std::max(highest_m, sample.p_W.z() - below_m);
    }
    RecordProperty("least_mm", static_cast<int>(1e3 * min_m));
    EXPECT_GE(min_m, 3.0 - 0.01) << alleys;
    EXPECT_LE(highest_m, 3.0 + 2.0 + 0.6) << alleys;  // not a chord high above the ground
    EXPECT_TRUE(over_rows);
    EXPECT_NEAR(bench.number("return_clearance_m"), min_m, 0.02);
  }
}

TEST(RowFlight, ComesDownToThreeMetresWhereThereIsNoCanopy) {
  FlightBench bench({.alleys = 2, .headland_m = 40.0}, make_bumpy_slope());
  bench.values = {{"turns", std::string("dubins")}};
  const auto plan = bench.plan(1.25, -35.0);
  ASSERT_TRUE(plan.ok()) << plan.reason();
  for (const PlanSample& sample : sample_plan(*plan, 0.1)) {
    if (sample.kind != PathKind::kReturn || sample.p_W.y() > -7.5) continue;
    const double above_m = sample.p_W.z() - bench.hill.ground_m(sample.p_W.head<2>());
    ASSERT_GE(above_m, 2.99);
    ASSERT_LE(above_m, 3.4);
  }
}

TEST(RowFlight, UsesTheGridPlannersTurns) {
  FlightBench bench({.alleys = 3, .row_length_m = 30.0}, make_bumpy_slope());
  const auto plan = bench.plan(1.25, -6.0);
  ASSERT_TRUE(plan.ok()) << plan.reason();
  EXPECT_EQ(bench.number("turns"), 2.0);
  EXPECT_GT(bench.number("clearance_m"), 0.05);
  PlannedPath rows;  // as the ground planner drives it
  for (const PathPoint& point : plan->points) {
    if (point.kind == PathKind::kReturn) break;
    if (point.kind != PathKind::kVertical) rows.points.push_back(point);
  }
  const SweptVerdict verdict =
      check_swept(rows, bench.vehicle.footprint_B, bench.map.occupancy, 0.1);
  EXPECT_EQ(verdict.fault, "");
  EXPECT_NEAR(verdict.min_m, bench.number("clearance_m"), bench.setup.cell_m);
  EXPECT_LE(verdict.sharpest_per_m, 1.0 / kRadius_m + 1e-9);
}

TEST(RowFlight, PlansTheSameTwice) {
  FlightBench a({.alleys = 3, .row_length_m = 30.0}), b({.alleys = 3, .row_length_m = 30.0});
  const auto first = a.plan(1.25, -6.0), second = b.plan(1.25, -6.0), again = b.plan(1.25, -6.0);
  ASSERT_TRUE(first.ok() && second.ok() && again.ok());
  ASSERT_EQ(first->points.size(), second->points.size());
  ASSERT_EQ(first->points.size(), again->points.size());
  for (std::size_t i = 0; i < first->points.size(); ++i) {
    ASSERT_EQ(first->points[i].p_W, second->points[i].p_W);
    ASSERT_EQ(first->points[i].p_W, again->points[i].p_W);
  }
}

/// A flying vehicle turns while it climbs: it never loops to the first row, however it stands.
TEST(RowFlight, TakesOffTowardsTheFirstRow) {
  for (const char* turns : {"grid", "dubins"}) {
    for (const double x : {-1.0, 0.6, 1.25, 1.8}) {
      FlightBench bench({.alleys = 1, .row_length_m = 20.0});
      bench.values = {{"turns", std::string(turns)}};
      const auto plan = bench.plan(x, -6.0, 2.0);
      ASSERT_TRUE(plan.ok()) << plan.reason();
      double transit_m = 0.0;
      for (const PlanSample& sample : sample_plan(*plan, 0.01)) {
        if (sample.kind == PathKind::kTransit) transit_m += 0.01;
      }
      EXPECT_LT(transit_m, 1.1 * Vec(x - 1.25, 6.0).norm() + 0.2) << turns << x;
    }
  }
}

TEST(RowFlight, BeginsInTheAlleyThatItStandsIn) {
  for (const char* turns : {"grid", "dubins"}) {
    for (const double x : {1.28, 1.0, 1.6}) {
      // Climbs to the middle where that is steep: it may well be there already.
      FlightBench bench({.alleys = 1, .row_length_m = 20.0});
      bench.values = {{"turns", std::string(turns)}};
      const auto plan = bench.plan(x, 4.0);
      ASSERT_TRUE(plan.ok()) << plan.reason();
      EXPECT_NEAR((plan->points[0].p_W - Eigen::Vector3d(x, 4.0, 0.2)).norm(), 0.0, 1e-12);
      EXPECT_NEAR((plan->points[1].p_W - Eigen::Vector3d(1.25, 4.0, 1.5)).norm(), 0.0, 1e-9);
      EXPECT_LT(std::abs(plan->points[1].yaw_rad - 0.5 * kPi), 0.05);
      EXPECT_NEAR(plan->points[2].p_W.x(), 1.25, 1e-9);
      EXPECT_GT(plan->points[2].p_W.y(), 4.0) << "no way back to the entrance";
    }
    // Where there is little to climb it does so on the spot and joins the middle ahead.
    FlightBench bench({.alleys = 1, .row_length_m = 20.0});
    bench.values = {{"turns", std::string(turns)}, {"height_m", 0.7}};
    const auto plan = bench.plan(1.55, 4.0);
    ASSERT_TRUE(plan.ok()) << plan.reason();
    EXPECT_NEAR((plan->points[1].p_W - Eigen::Vector3d(1.55, 4.0, 0.7)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(plan->points[2].p_W.x(), 1.25, 1e-9);
    EXPECT_NEAR(plan->points[2].p_W.y(), 5.0, 0.5);
  }
}

TEST(RowFlight, MayLandAtTheEndOfTheLastRow) {
  FlightBench bench({.alleys = 1, .row_length_m = 20.0});
  bench.values = {{"return_home", false}, {"turns", std::string("dubins")}};
  const auto plan = bench.plan(1.25, -1.0);
  ASSERT_TRUE(plan.ok()) << plan.reason();
  EXPECT_NEAR((plan->points.back().p_W - Eigen::Vector3d(1.25, 20.0, 0.2)).norm(), 0.0, 1e-9);
  EXPECT_EQ(plan->points[plan->points.size() - 2].kind, PathKind::kVertical);
  EXPECT_NEAR(plan->length_m, 1.3 + 21.0 + 1.3, 1e-9);
}

TEST(RowFlight, WithoutASceneTheGroundIsFlatWhereItStands) {
  FlightBench bench({.alleys = 1, .row_length_m = 20.0}, make_flat(3.0));
  bench.scene = nullptr;
  bench.values = {{"turns", std::string("dubins")}};
  const auto plan = bench.plan(1.25, -1.0);
  ASSERT_TRUE(plan.ok()) << plan.reason();
  EXPECT_NEAR(plan->points[1].p_W.z(), 4.5, 1e-12);
  EXPECT_NEAR(plan->points.back().p_W.z(), 3.2, 1e-12);
}

std::string failure_of(FlightBench& bench, double x, double y) {
  const auto plan = bench.plan(x, y);
  return plan.ok() ? "" : plan.reason();
}

TEST(RowFlight, TellsWhyThereIsNoPlan) {
  FlightBench bench({.alleys = 2, .row_length_m = 20.0});
  EXPECT_EQ(failure_of(bench, 2.4, 10.0),
            "cannot take off at (2.40, 10.00): 0.10 m from the centre line of row 1, whose canopy "
            "is 0.60 m wide; straight up and down needs 0.55 m to the canopy on every side");
  FlightBench narrow({.alleys = 2, .row_length_m = 20.0, .headland_m = 3.0});
  narrow.values = {{"first_iterations", std::int64_t{200}}};
  const std::string too_narrow = failure_of(narrow, 1.25, -1.0);
  EXPECT_THAT(too_narrow, HasSubstr("the turn from alley 0 to alley 1 needs"));
  EXPECT_THAT(too_narrow, HasSubstr("more clearance at the turning radius of 1.77 m"));
  FlightBench closed({.alleys = 2, .row_length_m = 20.0, .canopy_m = 1.6});
  closed.values = {{"turns", std::string("dubins")}};
  EXPECT_THAT(
      failure_of(closed, 1.25, -3.0),
      HasSubstr("path into a row: the path passes (1.25, -0.75), 1.35 m from the centre line of "
                "row 0, whose canopy is 1.60 m wide and needs a clearance of 0.55 m"));
  FlightBench arcs({.alleys = 2, .row_length_m = 20.0});
  arcs.values = {{"turns", std::string("three_point_arc")}};
  EXPECT_THAT(failure_of(arcs, 1.25, -1.0),
              HasSubstr("turn from alley 0 to alley 1: the three-point arc between alleys 2.5 m "
                        "apart has a radius of 1.25 m, below turning_radius_m = 1.77 m; use "
                        "turns: dubins, whose loop fits any spacing"));
  FlightBench high({.alleys = 1, .row_length_m = 20.0});
  high.hill = PlainScene([](double, double y) { return y > -3.0 ? 0.0 : 4.0; });
  high.vehicle.height_above_ground_m = -3.0;  // stands in a hollow that the map does not have
  high.values = {{"smooth_m", 0.0}, {"turns", std::string("dubins")}};
  Pose start;
  start.p = {1.25, -4.0, 6.0};
  const auto plan = high.make()->plan(start);
  ASSERT_FALSE(plan.ok());
  EXPECT_EQ(plan.reason(),
            "cannot climb at (1.25, -4.00): the flying height there is 5.50 m, 1.50 m above the "
            "map's ground, and the vehicle is at 6.00 m already");
}

std::string refusal_of(const FlightBench& bench) {
  try {
    bench.make();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(RowFlight, RefusesWhatCannotBeFlown) {
  FlightBench bench({.alleys = 1, .row_length_m = 20.0});
  bench.values = {{"height_m", 0.15}};
  EXPECT_EQ(refusal_of(bench),
            "drone.planner (row_flight): height_m = 0.15 m is not above 0.20 m, the height of "
            "the centre of mass of vehicle type 'quadrotor' on the ground");
  bench.values = {{"return_height_m", 1.2}};
  EXPECT_EQ(refusal_of(bench),
            "drone.planner (row_flight): return_height_m = 1.20 m is not above height_m = 1.50 m, "
            "so there is no climb at the end of the last row");
  bench.values = {{"alleys", std::vector<double>{1.0}}};
  EXPECT_THAT(refusal_of(bench), HasSubstr("alleys holds 1, must be whole numbers from 0 to 0"));
  bench.values = {};
  FlightBench rover({.alleys = 1, .row_length_m = 20.0});
  rover.vehicle.type = "four_wheel_steering_rover";
  rover.vehicle.rotorcraft.reset();
  EXPECT_EQ(refusal_of(rover),
            "drone.planner (row_flight) plans flights, but vehicle type "
            "'four_wheel_steering_rover' does not fly");
  bench.map.occupancy = {};
  EXPECT_EQ(refusal_of(bench),
            "drone.planner (row_flight): the map has no occupancy grid: set occupancy_cell_m, or "
            "turns: dubins");
  bench.map.alleys.clear();
  EXPECT_EQ(refusal_of(bench), "drone.planner (row_flight): the map has no alleys to drive");
}

}  // namespace
}  // namespace vinerow::test::row_flight_test
