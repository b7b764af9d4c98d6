#include "controllers/planning/search/car_space.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "controllers/planning/search/bounded_nearest.h"
#include "controllers/planning/search/car_planners.h"
#include "controllers/planning/search/initial_path.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/block_map.h"

namespace vinerow::test::car_space_test {
namespace {

using Vec = Eigen::Vector2d;
constexpr double kRadius_m = 1.5;

controllers::Pose2 draw_pose(RandomStream& random) {
  const double x = random.uniform(-5, 5), y = random.uniform(-5, 5);
  return {{x, y}, random.uniform(-kPi, kPi)};
}

TEST(CarSpace, TakesEveryHeading) {
  const controllers::CarSpace space(kRadius_m, {-10, -10}, {10, 10});
  auto* state = space.allocState();
  for (const double yaw_rad : {kPi, -kPi, 3 * kPi, -3 * kPi, 1e3, std::nextafter(kPi, 0.0)}) {
    controllers::CarSpace::set_pose({{1, 2}, yaw_rad}, state);
    EXPECT_TRUE(space.satisfiesBounds(state)) << yaw_rad;
    EXPECT_NEAR(wrap_angle(controllers::CarSpace::pose_of(state).yaw_rad - yaw_rad), 0.0, 1e-12);
  }
  space.freeState(state);
}

TEST(CarSpace, InterpolatesAlongTheShortestPath) {
  const controllers::CarSpace space(kRadius_m, {-10, -10}, {10, 10});
  auto *from = space.allocState(), *to = space.allocState(), *at = space.allocState();
  RandomStream random(1, "a", "b");
  for (int n = 0; n < 300; ++n) {
    const controllers::Pose2 a = draw_pose(random), b = draw_pose(random);
    controllers::CarSpace::set_pose(a, from);
    controllers::CarSpace::set_pose(b, to);
    EXPECT_NEAR(space.distance(from, to), controllers::calc_dubins(a, b, kRadius_m).length_m(),
                1e-9);
    const double share = random.uniform();
    space.interpolate(from, to, share, at);
    // A point of a shortest path: what lies before and after adds up to the whole.
    EXPECT_NEAR(space.distance(from, at), share * space.distance(from, to), 1e-6);
    EXPECT_NEAR(space.distance(at, to), (1 - share) * space.distance(from, to), 1e-6);
  }
  EXPECT_NEAR(space.distance(from, from), 0.0, 1e-9);
  space.freeState(from);
  space.freeState(to);
  space.freeState(at);
}

TEST(BoundedNearest, EqualsBruteForce) {
  const auto distance = [](const controllers::Pose2& a, const controllers::Pose2& b) {
    return controllers::calc_dubins(a, b, kRadius_m).length_m();
  };
  std::vector<controllers::Pose2> poses;
  RandomStream random(2, "a", "b");
  for (int n = 0; n < 400; ++n) poses.push_back(draw_pose(random));
  constexpr double kLongest = 6.0;
  controllers::BoundedNearest<int> nearest(
      [&](const int& a, const int& b) {
        return std::max(
            (poses[b].p - poses[a].p).norm(),
            kRadius_m * std::abs(wrap_angle(poses[b].yaw_rad - poses[a].yaw_rad)) - 1e-9);
      },
      kLongest);
  nearest.setDistanceFunction(
      [&](const int& a, const int& b) { return distance(poses[a], poses[b]); });
  for (int i = 0; i < 300; ++i) nearest.add(i);
  EXPECT_EQ(nearest.size(), 300u);
  for (int query = 300; query < 400; ++query) {
    std::vector<std::pair<double, int>> sorted;
    for (int i = 0; i < 300; ++i) sorted.emplace_back(distance(poses[i], poses[query]), i);
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(nearest.nearest(query), sorted[0].second);
    std::vector<int> found, expected;
    for (int i = 0; i < 15 && sorted[i].first <= kLongest; ++i)
      expected.push_back(sorted[i].second);
    nearest.nearestK(query, 15, found);
    EXPECT_EQ(found, expected);
    expected.clear();
    for (int i = 0; sorted[i].first <= 4.0; ++i) expected.push_back(sorted[i].second);
    nearest.nearestR(query, 4.0, found);
    EXPECT_EQ(found, expected);
  }
  EXPECT_TRUE(nearest.remove(7));
  EXPECT_FALSE(nearest.remove(7));
}

/// An alley 2 m wide along x between walls at y = +-1.
OccupancyGrid make_corridor() {
  OccupancyGrid grid{600, 100, 0.05, {-15, -2.5}, std::vector<std::uint8_t>(600 * 100, 0)};
  mark(grid, {-15, 1.025}, {15, 1.025}, 0.0);
  mark(grid, {-15, -1.025}, {15, -1.025}, 0.0);
  return grid;
}

TEST(PathCost, IsTheIntegralOfLackingClearance) {
  const OccupancyGrid grid = make_corridor();
  const controllers::DistanceField field(grid);
  const controllers::Footprint footprint(field, make_four_wheel_description().footprint_B, 0.05);
  // Along the middle the hull has half a metre, less cells, to either side.
  const double clearance_m = footprint.clearance_m({{0, 0}, 0.0});
  EXPECT_NEAR(clearance_m, 0.5, 0.051);
  const controllers::PathCost cost({0.5, 1.0, 0.1, 0.25}, footprint);
  const controllers::PathSegment along{{{-5, 0}, 0.0}, 8.0, 0.0, PathKind::kTurn, -1, 0.0};
  EXPECT_NEAR(cost.of(along), 8.0 * (1.0 + 0.5 * (1.0 - clearance_m)), 1e-6);
  EXPECT_EQ(controllers::PathCost({0.0, 1.0, 0.1, 0.25}, footprint).of(along), 8.0);
  EXPECT_EQ(controllers::PathCost({0.5, 0.3, 0.1, 0.25}, footprint).of(along),
            8.0);  // all that is wanted
  EXPECT_NEAR(cost.max_of(8.0), 12.2, 1e-12);
  // Every change of curvature counts once, also between pieces of a Dubins path.
  const controllers::DubinsPath loop =
      controllers::calc_dubins({{0, 0}, 0.5 * kPi}, {{2.5, 0}, -0.5 * kPi}, 1.767);
  std::vector<controllers::PathSegment> pieces;
  controllers::append_dubins({{0, 0}, 0.5 * kPi}, loop, PathKind::kTurn, 0.0, pieces);
  const controllers::PathCost bends({0.0, 1.0, 0.1, 0.25}, footprint);
  EXPECT_NEAR(bends.of(pieces), loop.length_m() + 0.2, 1e-9);
  EXPECT_NEAR(bends.of({{0, 0}, 0.5 * kPi}, loop), loop.length_m() + 0.2, 1e-9);
  RandomStream random(3, "a", "b");
  for (int n = 0; n < 200; ++n) {
    const controllers::PathSegment piece{draw_pose(random),
                                         random.uniform(0.1, 6.0),
                                         random.uniform(-0.6, 0.6),
                                         PathKind::kTurn,
                                         -1,
                                         0.0};
    EXPECT_GE(cost.of(piece), piece.length_m);
    EXPECT_LE(cost.of(piece), cost.max_of(piece.length_m) + 1e-12);
  }
}

TEST(Shorten, KeepsEndsAndNeverCostsMore) {
  const OccupancyGrid grid = make_block({.row_length_m = 8.0, .has_walls = false}).occupancy;
  const controllers::DistanceField field(grid);
  const controllers::Footprint footprint(field, make_four_wheel_description().footprint_B, 0.05);
  const controllers::PathCost cost({0.5, 0.3, 0.2, 0.25}, footprint);
  // A detour over a pose far out in the headland.
  const std::vector<controllers::Pose2> poses = {
      {{1.25, 8.0}, 0.5 * kPi}, {{2.5, 15.0}, 0.0}, {{3.75, 8.0}, -0.5 * kPi}};
  const auto detour = controllers::join_poses(poses, 1.767);
  const auto shorter = controllers::shorten_by_cost(detour, 1.767, footprint, cost, 0.1);
  EXPECT_LT(cost.of(shorter), 0.9 * cost.of(detour));
  EXPECT_TRUE(controllers::is_free(shorter, footprint, 0.1));
  EXPECT_NEAR((shorter.front().start.p - poses[0].p).norm(), 0.0, 1e-9);
  EXPECT_NEAR((shorter.back().end().p - poses[2].p).norm(), 0.0, 1e-6);
  EXPECT_NEAR(wrap_angle(shorter.back().end().yaw_rad - poses[2].yaw_rad), 0.0, 1e-6);
}

TEST(CarPlanners, SameSeedSameTreeWhateverRunsBetween) {
  const RowMap map = make_block({.row_length_m = 8.0, .has_walls = false});
  const controllers::DistanceField field(map.occupancy);
  const controllers::Footprint footprint(field, make_four_wheel_description().footprint_B, 0.05);
  const controllers::PathCost cost({0.5, 0.3, 0.2, 0.25}, footprint);
  controllers::CarProblem problem{1.767, {-4, 4}, {9, 18}, &footprint, &cost, 0.1, 3.0, 400};
  controllers::CarSampling sampling;
  sampling.from = {{1.25, 8.0}, 0.5 * kPi};
  sampling.to = {{3.75, 8.0}, -0.5 * kPi};
  sampling.footprint = &footprint;
  sampling.best_cost = [] { return 1e9; };
  const auto positions = [](const controllers::CarTree& tree) {
    std::vector<Vec> points;
    for (const auto& edge : tree.edges) points.push_back(edge.second.p);
    return points;
  };
  for (const auto run : {controllers::run_rrt_star, controllers::run_rrt}) {
    const controllers::CarTree first = run(problem, sampling, RandomStream(1, "a", "b"));
    EXPECT_FALSE(first.waypoints.empty());
    const controllers::CarTree other = run(problem, sampling, RandomStream(2, "a", "b"));
    controllers::run_rrt(problem, sampling, RandomStream(3, "a", "b"));
    controllers::run_rrt_star(problem, sampling, RandomStream(4, "a", "b"));
    const controllers::CarTree again = run(problem, sampling, RandomStream(1, "a", "b"));
    EXPECT_EQ(positions(first), positions(again));
    EXPECT_EQ(first.iterations, again.iterations);
    EXPECT_NE(positions(first), positions(other));
    EXPECT_TRUE(
        controllers::is_free(controllers::join_poses(first.waypoints, 1.767), footprint, 0.1));
    EXPECT_NEAR((first.waypoints.front().p - sampling.from.p).norm(), 0.0, 1e-12);
    EXPECT_NEAR((first.waypoints.back().p - sampling.to.p).norm(), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace vinerow::test::car_space_test
