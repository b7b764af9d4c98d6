#include "controllers/planning/search/quartile_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/controllers/planning/search/quartile_runs.h"

namespace vinerow::controllers::quartile_tree_test {
namespace {

using hand_grids::rover_outline_B;
using hand_grids::Vineyard;
using namespace quartile_runs;

// A half turn at radius R moves a vehicle 2 R sideways at least: 5.20 m, and it is 1 m wide; there
// are 5.0 m between the walls. So no planner can solve this, and the tree has to run dry.
TEST(QuartileTree, ThePapersTwoWheelTurnBetweenWallsExhaustsTheTree) {
  const Vineyard vineyard;
  const Site site(vineyard.make(), 0.0);
  for (const DistanceKind kind : {DistanceKind::kGeodesic, DistanceKind::kEuclid}) {
    for (const bool quartiles : {true, false}) {
      RrtQuartileParams params = make_params(kTwoWheel_per_m);
      params.heuristic = kind;
      params.tree.quartiles = quartiles;
      params.refinements = 0;
      const Found run = find(site, vineyard.exit(0), vineyard.entry(1), params);
      ASSERT_FALSE(run.pieces);
      EXPECT_EQ(run.pieces.reason().find("tree exhausted, no sequence of arcs of 2.60 m radius "
                                         "leads there ("),
                0u)
          << run.pieces.reason();
      EXPECT_NE(
          run.pieces.reason().find(std::to_string(run.report.nodes) + " nodes in steps of 0.4 m)"),
          std::string::npos)
          << run.pieces.reason();
      // A plain implementation in another language ended with 1888; the order is the same.
      EXPECT_GT(run.report.nodes, 1000);
      EXPECT_LT(run.report.nodes, 6000);
    }
  }
  const Found finer = find(site, vineyard.exit(0), vineyard.entry(1), make_params(kTwoWheel_per_m));
  ASSERT_FALSE(finer.pieces);
  EXPECT_NE(finer.pieces.reason().find("in steps of 0.4 m, "), std::string::npos);
  EXPECT_NE(finer.pieces.reason().find("in steps of 0.2 m)"), std::string::npos);
}

TEST(QuartileTree, WithoutWallsTheTwoWheelTurnIsSolved) {
  Vineyard vineyard;
  vineyard.walls = false;
  const Site site(vineyard.make());
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Found run =
        find(site, vineyard.exit(0), vineyard.entry(1), make_params(kTwoWheel_per_m), seed);
    ASSERT_TRUE(run.pieces) << run.pieces.reason();
    expect_drivable(site, vineyard.exit(0), vineyard.entry(1), *run.pieces, kTwoWheel_per_m);
  }
}

std::int64_t median_nodes(const Site& site, const Pose2& from, const Pose2& to, DistanceKind kind,
                          bool quartiles) {
  RrtQuartileParams params = make_params();
  params.heuristic = kind;
  params.tree.quartiles = quartiles;
  params.smooth = false;
  std::vector<std::int64_t> nodes;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Found run = find(site, from, to, params, seed);
    EXPECT_TRUE(run.pieces);
    nodes.push_back(run.report.nodes);
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes[2];
}

// The paper's reason for quartiles: without them the process was too time consuming.
TEST(QuartileTree, QuartilesSaveNodes) {
  const Vineyard vineyard;
  const Site site(vineyard.make());
  const Pose2 from = {{1.0, 0.0}, 0.0}, to = {{1.0, 2.5}, kPi};
  const auto with = median_nodes(site, from, to, DistanceKind::kGeodesic, true);
  const auto without = median_nodes(site, from, to, DistanceKind::kGeodesic, false);
  RecordProperty("nodes", std::to_string(with));
  RecordProperty("nodes_without_quartiles", std::to_string(without));
  EXPECT_LT(1.5 * with, without);
}

// Three alleys to drive one after the other: the straight line to the goal crosses two rows.
TEST(QuartileTree, DistanceAlongTheGroundSavesNodes) {
  Vineyard vineyard;
  vineyard.alleys = 3;
  const Site site(vineyard.make());
  const Pose2 from = {{1.0, 0.0}, 0.0}, to = {{29.0, 5.0}, 0.0};
  const auto geodesic = median_nodes(site, from, to, DistanceKind::kGeodesic, true);
  const auto euclid = median_nodes(site, from, to, DistanceKind::kEuclid, true);
  RecordProperty("nodes_geodesic", std::to_string(geodesic));
  RecordProperty("nodes_euclid", std::to_string(euclid));
  EXPECT_LT(1.5 * geodesic, euclid);
}

// Steps of 4 m and a post between their ends: the arc is swept whatever the distance of the poses
// that are checked.
TEST(QuartileTree, TheSweptCheckSeesAPostBetweenTheEndsOfAStep) {
  OccupancyGrid grid = hand_grids::make_free_grid({-2, -3}, {14, 3});
  const Site open(grid);
  hand_grids::fill(grid, 2.0, 0.0, 2.05, 0.05);
  const Site with_post(std::move(grid));
  const Pose2 from = {{0, 0}, 0.0}, to = {{12, 0}, 0.0};
  RrtQuartileParams params = make_params(0.1);
  params.tree.step_m = 4.0;
  params.smooth = false;
  params.tree.join_m = 4.5;
  for (const double check_step_m : {4.0, 0.15}) {
    params.tree.check_step_m = check_step_m;
    EXPECT_TRUE(find(open, from, to, params).pieces);
    const Found seeing = find(with_post, from, to, params);
    ASSERT_FALSE(seeing.pieces);
    EXPECT_EQ(seeing.report.nodes, 2) << "the roots of the tree and of the finer one";
  }
}

// At a margin of 0.07 m the turning area leaves about 2 cm of play.
TEST(QuartileTree, FinerStepsFindWhatTheFirstTreeMisses) {
  const Vineyard vineyard;
  const Site site(vineyard.make(), 0.07);
  int coarse_solved = 0;
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    RrtQuartileParams params = make_params();
    params.smooth = false;
    const Found run = find(site, vineyard.exit(0), vineyard.entry(1), params, seed);
    ASSERT_TRUE(run.pieces) << run.pieces.reason();
    expect_drivable(site, vineyard.exit(0), vineyard.entry(1), *run.pieces, kFourWheel_per_m);
    params.refinements = 0;
    coarse_solved += find(site, vineyard.exit(0), vineyard.entry(1), params, seed).pieces.ok();
  }
  EXPECT_LT(coarse_solved, kSeeds);
}

TEST(QuartileTree, TheTreesStrokesStartAtTheStartAndTouchNothing) {
  const Vineyard vineyard;
  const Site site(vineyard.make());
  const Found run = find(site, vineyard.exit(0), vineyard.entry(1), make_params());
  const std::vector<Eigen::Vector2d>& strokes = run.report.tree_W;
  ASSERT_EQ(static_cast<std::int64_t>(strokes.size()), 4 * (run.report.nodes - 1));
  EXPECT_EQ(strokes[0], vineyard.exit(0).p);
  for (std::size_t i = 0; i < strokes.size(); i += 2) {
    const double stroke_m = (strokes[i + 1] - strokes[i]).norm();
    ASSERT_LT(stroke_m, 0.2 + 1e-9);
    ASSERT_GT(stroke_m, 0.199);
    ASSERT_GE(site.field.at(strokes[i + 1]), 0.5) << "half the vehicle's width";
  }
}

}  // namespace
}  // namespace vinerow::controllers::quartile_tree_test
