#include "controllers/planning/search/goal_distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/controllers/planning/search/hand_grids.h"

namespace vinerow::controllers::goal_distance_test {
namespace {

using hand_grids::fill;
using hand_grids::make_free_grid;
using hand_grids::rover_outline_B;

TEST(GoalDistance, StraightIsEquation22) {
  const DistanceField nothing;
  const Footprint footprint(nothing, rover_outline_B(), 0.0);
  const GoalDistance distance(DistanceKind::kEuclid, footprint, {0, 0}, {3, 4});
  EXPECT_DOUBLE_EQ(distance.at({0, 0}), 5.0);
  EXPECT_DOUBLE_EQ(distance.at({6, 8}), 5.0);
  EXPECT_DOUBLE_EQ(distance.at({3, 4}), 0.0);
}

TEST(GoalDistance, WithoutGridTheGroundIsEverywhere) {
  const DistanceField nothing;
  const Footprint footprint(nothing, rover_outline_B(), 0.0);
  const GoalDistance distance(DistanceKind::kGeodesic, footprint, {0, 0}, {3, 4});
  EXPECT_DOUBLE_EQ(distance.at({-1000, 4}), 1003.0);
}

TEST(GoalDistance, OnFreeGroundItIsTheLengthOverEightNeighbours) {
  const OccupancyGrid grid = make_free_grid({0, 0}, {30, 30});
  const DistanceField field(grid);
  const Footprint footprint(field, rover_outline_B(), 0.05);
  const Eigen::Vector2d goal = {15.1, 15.1};
  const GoalDistance distance(DistanceKind::kGeodesic, footprint, {2, 2}, goal);
  for (const auto& [x, y] : {std::pair{3.1, 15.1}, {15.1, 27.1}, {5.1, 10.1}, {25.1, 20.1}}) {
    const double dx = std::abs(x - goal.x()), dy = std::abs(y - goal.y());
    // Straight moves and diagonals of 7/5: closed form for cells whose centres are the points.
    const double octile_m = std::max(dx, dy) + 0.4 * std::min(dx, dy);
    EXPECT_NEAR(distance.at({x, y}), octile_m, 1e-9) << x << ", " << y;
    EXPECT_GE(distance.at({x, y}), 0.99 * std::hypot(dx, dy));
    EXPECT_LE(distance.at({x, y}), 1.083 * std::hypot(dx, dy));  // 1/cos(22.5 deg): eight headings
  }
}

TEST(GoalDistance, LeadsAroundTheRowsEnd) {
  const hand_grids::Vineyard vineyard;  // 30 m rows
  const DistanceField field(vineyard.make());
  const Footprint footprint(field, rover_outline_B(), 0.05);
  const Eigen::Vector2d goal = {1.0, 2.5}, start = {1.0, 0.0};
  const GoalDistance distance(DistanceKind::kGeodesic, footprint, start, goal);
  // Along both alleys and over: at least 29 + 2.5 + 29 less what cutting corners saves.
  EXPECT_GT(distance.at(start), 58.0);
  EXPECT_LT(distance.at(start), 62.0);
  EXPECT_LT(distance.at({29.0, 0.0}), distance.at({28.0, 0.0}));
  EXPECT_GT(distance.at({30.0, 2.5}), distance.at({29.0, 2.5}));
  const GoalDistance straight(DistanceKind::kEuclid, footprint, start, goal);
  EXPECT_DOUBLE_EQ(straight.at(start), 2.5) << "into the row";
}

TEST(GoalDistance, WhatIsCutOffIsInfinitelyFar) {
  OccupancyGrid grid = make_free_grid({0, 0}, {20, 10});
  fill(grid, 10.0, 0.0, 10.1, 10.0);
  const auto measure = [](const OccupancyGrid& g, const Eigen::Vector2d& p) {
    const DistanceField field(g);
    const Footprint footprint(field, rover_outline_B(), 0.05);
    return GoalDistance(DistanceKind::kGeodesic, footprint, {5, 5}, {15, 5}).at(p);
  };
  EXPECT_TRUE(std::isinf(measure(grid, {5, 5})));
  EXPECT_TRUE(std::isinf(measure(grid, {25, 5}))) << "outside the grid";
  OccupancyGrid slit = make_free_grid({0, 0}, {20, 10});
  fill(slit, 10.0, 0.0, 10.1, 4.85);
  fill(slit, 10.0, 5.15, 10.1, 10.0);
  EXPECT_TRUE(std::isinf(measure(slit, {5, 5}))) << "no vehicle passes 0.3 m";
  OccupancyGrid gate = make_free_grid({0, 0}, {20, 10});
  fill(gate, 10.0, 0.0, 10.1, 4.4);
  fill(gate, 10.0, 5.6, 10.1, 10.0);
  EXPECT_LT(measure(gate, {5, 5}), 11.0) << "1.2 m is wide enough";
}

}  // namespace
}  // namespace vinerow::controllers::goal_distance_test
