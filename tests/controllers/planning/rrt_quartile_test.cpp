#include "controllers/planning/rrt_quartile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "tests/controllers/planning/hand_grids.h"

namespace vinerow {
namespace {

using hand_grids::length_m;
using hand_grids::rover_outline_B;
using hand_grids::Vineyard;

constexpr double kFourWheel_per_m = 0.566;                 // 23 deg on both axles, base 1.5 m
const double kTwoWheel_per_m = std::tan(kPi / 6.0) / 1.5;  // paper A: +-pi/6 on the front axle
constexpr double kMargin_m = 0.05;

/// A grid with everything that refers to it.
struct Site {
  explicit Site(OccupancyGrid g, double margin_m = kMargin_m)
      : grid(std::move(g)), field(grid), footprint(field, rover_outline_B(), margin_m) {}
  OccupancyGrid grid;
  DistanceField field;
  Footprint footprint;
};

struct Found {
  SearchReport report;
  Result<std::vector<PathPiece>> pieces = Failure{};
};

Found find(const Site& site, const Pose2& from, const Pose2& to, const RrtQuartileParams& params,
           std::uint64_t seed = 1, int problem = 1) {
  PartContext context;
  context.vehicle = "rover";
  context.part = "rover.planner";
  context.seed = seed;
  RrtQuartile search(params, context);
  Found run;
  run.pieces = search.find(from, to, site.footprint, problem, run.report);
  return run;
}

RrtQuartileParams make_params(double curvature_per_m = kFourWheel_per_m) {
  RrtQuartileParams params;
  params.tree.curvature_per_m = curvature_per_m;
  return params;
}

/// Starts and ends exactly, hangs together, turns no tighter than allowed, touches nothing.
void expect_drivable(const Site& site, const Pose2& from, const Pose2& to,
                     const std::vector<PathPiece>& pieces, double curvature_per_m) {
  ASSERT_FALSE(pieces.empty());
  Pose2 at = from;
  for (const PathPiece& piece : pieces) {
    EXPECT_LT((piece.start.p - at.p).norm(), 1e-9);
    EXPECT_NEAR(wrap_angle(piece.start.yaw_rad - at.yaw_rad), 0.0, 1e-9);
    EXPECT_GT(piece.length_m, 0.0);
    EXPECT_LE(std::abs(piece.curvature_per_m), curvature_per_m * (1.0 + 1e-12));
    EXPECT_EQ(piece.kind, PathKind::kTurn);
    at = piece.end();
  }
  EXPECT_LT((at.p - to.p).norm(), 1e-6);
  EXPECT_NEAR(wrap_angle(at.yaw_rad - to.yaw_rad), 0.0, 1e-6);
  EXPECT_FALSE(hand_grids::path_touches(site.grid, rover_outline_B(), pieces));
}

TEST(RrtQuartile, TurnsBetweenTheWallsWithEverySeed) {
  const Vineyard vineyard;
  const Site site(vineyard.make());
  const Pose2 from = vineyard.exit(0), to = vineyard.entry(1);
  const double shortest_m = calc_dubins(from, to, 1.0 / kFourWheel_per_m).length_m();
  std::vector<double> lengths_m, first_lengths_m;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Found run = find(site, from, to, make_params(), seed);
    ASSERT_TRUE(run.pieces) << "seed " << seed << ": " << run.pieces.reason();
    expect_drivable(site, from, to, *run.pieces, kFourWheel_per_m);
    EXPECT_GE(length_m(*run.pieces), shortest_m - 1e-9);
    EXPECT_LE(length_m(*run.pieces), run.report.first_length_m + 1e-9);
    EXPECT_LT(run.report.iterations, run.report.nodes);
    first_lengths_m.push_back(run.report.first_length_m);
    lengths_m.push_back(length_m(*run.pieces));
  }
  std::sort(lengths_m.begin(), lengths_m.end());
  std::sort(first_lengths_m.begin(), first_lengths_m.end());
  EXPECT_GT(first_lengths_m.back() - first_lengths_m.front(), 0.01) << "seeds differ";
  EXPECT_LT(lengths_m[10], 1.05 * shortest_m);
  RecordProperty("median_length_m", std::to_string(lengths_m[10]));
}

TEST(RrtQuartile, TheSameCallGivesTheSameBits) {
  const Vineyard vineyard;
  const Site site(vineyard.make());
  const auto all_bits = [&](std::uint64_t seed, int problem) {
    const Found run = find(site, vineyard.exit(0), vineyard.entry(1), make_params(), seed, problem);
    std::vector<double> bits = {double(run.report.nodes), double(run.report.iterations)};
    for (const PathPiece& piece : *run.pieces) {
      bits.insert(bits.end(), {piece.start.p.x(), piece.start.p.y(), piece.start.yaw_rad,
                               piece.length_m, piece.curvature_per_m});
    }
    for (const Eigen::Vector2d& p : run.report.tree_W) bits.insert(bits.end(), {p.x(), p.y()});
    return bits;
  };
  EXPECT_EQ(all_bits(7, 3), all_bits(7, 3));
  EXPECT_NE(all_bits(7, 3), all_bits(8, 3)) << "the seed matters";
  EXPECT_NE(all_bits(7, 3), all_bits(7, 4)) << "every turn has its own stream";
}

// A half turn at radius R moves a vehicle 2 R sideways at least: 5.20 m, and it is 1 m wide; there
// are 5.0 m between the walls. So no planner can solve this, and the tree has to run dry.
TEST(RrtQuartile, ThePapersTwoWheelTurnBetweenWallsExhaustsTheTree) {
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

TEST(RrtQuartile, WithoutWallsTheTwoWheelTurnIsSolved) {
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

// Rows 30 m long, start and goal 1 m inside neighbouring alleys: the goal is 2.5 m away, the
// way 67.
TEST(RrtQuartile, FindsBothAlleysAndTheTurnInOneSearch) {
  const Vineyard vineyard;
  const Site site(vineyard.make());
  const Pose2 from = {{1.0, 0.0}, 0.0}, to = {{1.0, 2.5}, kPi};
  const double shortest_m =
      58.0 + calc_dubins(vineyard.exit(0), vineyard.entry(1), 1.0 / kFourWheel_per_m).length_m();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Found run = find(site, from, to, make_params(), seed);
    ASSERT_TRUE(run.pieces) << run.pieces.reason();
    expect_drivable(site, from, to, *run.pieces, kFourWheel_per_m);
    EXPECT_GT(length_m(*run.pieces), 58.0);
    EXPECT_LT(length_m(*run.pieces), 1.1 * shortest_m);
  }
}

TEST(RrtQuartile, FindsRowsOf118MetresInOneSearch) {
  Vineyard vineyard;
  vineyard.length_m = 118.0;
  const Site site(vineyard.make());
  const Pose2 from = {{1.0, 0.0}, 0.0}, to = {{1.0, 2.5}, kPi};
  const Found run = find(site, from, to, make_params());
  ASSERT_TRUE(run.pieces) << run.pieces.reason();
  expect_drivable(site, from, to, *run.pieces, kFourWheel_per_m);
  EXPECT_LT(length_m(*run.pieces), 260.0);
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
TEST(RrtQuartile, QuartilesSaveNodes) {
  const Vineyard vineyard;
  const Site site(vineyard.make());
  const Pose2 from = {{1.0, 0.0}, 0.0}, to = {{1.0, 2.5}, kPi};
  const auto with = median_nodes(site, from, to, DistanceKind::kGeodesic, true);
  const auto without = median_nodes(site, from, to, DistanceKind::kGeodesic, false);
  RecordProperty("nodes", std::to_string(with));
  RecordProperty("nodes_without_quartiles", std::to_string(without));
  EXPECT_LT(2 * with, without);
}

// Three alleys to drive one after the other: the straight line to the goal crosses two rows.
TEST(RrtQuartile, DistanceAlongTheGroundSavesNodes) {
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

// Steps of 4 m and a post between their ends: checked at the ends only, the way goes through it.
TEST(RrtQuartile, TheSweptCheckSeesAPostBetweenTheEndsOfAStep) {
  OccupancyGrid grid = hand_grids::make_free_grid({-2, -3}, {14, 3});
  hand_grids::fill(grid, 2.0, 0.0, 2.05, 0.05);
  const Site site(std::move(grid));
  const Pose2 from = {{0, 0}, 0.0}, to = {{12, 0}, 0.0};
  RrtQuartileParams params = make_params(0.1);
  params.tree.step_m = 4.0;
  params.smooth = false;
  params.tree.join_m = 4.5;
  params.tree.check_step_m = 4.0;
  const Found blind = find(site, from, to, params);
  ASSERT_TRUE(blind.pieces) << blind.pieces.reason();
  EXPECT_TRUE(hand_grids::path_touches(site.grid, rover_outline_B(), *blind.pieces));
  params.tree.check_step_m = 0.15;
  const Found seeing = find(site, from, to, params);
  ASSERT_FALSE(seeing.pieces);
  EXPECT_EQ(seeing.report.nodes, 2) << "the roots of the tree and of the finer one";
}

// At a margin of 0.07 m the turning area leaves about 2 cm of play.
TEST(RrtQuartile, FinerStepsFindWhatTheFirstTreeMisses) {
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

TEST(RrtQuartile, SmoothingKeepsEndsAndNeverLengthens) {
  Vineyard vineyard;
  vineyard.walls = false;
  const Site site(vineyard.make());
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RrtQuartileParams params = make_params();
    const Found smooth = find(site, vineyard.exit(0), vineyard.entry(1), params, seed);
    params.smooth = false;
    const Found rough = find(site, vineyard.exit(0), vineyard.entry(1), params, seed);
    ASSERT_TRUE(smooth.pieces && rough.pieces);
    expect_drivable(site, vineyard.exit(0), vineyard.entry(1), *rough.pieces, kFourWheel_per_m);
    EXPECT_DOUBLE_EQ(smooth.report.first_length_m, length_m(*rough.pieces));
    EXPECT_EQ(rough.report.first_length_m, 0.0) << "told only where something was improved";
    EXPECT_LE(length_m(*smooth.pieces), length_m(*rough.pieces));
    EXPECT_EQ(smooth.report.nodes, rough.report.nodes);
  }
}

TEST(RrtQuartile, TheTreesStrokesStartAtTheStartAndTouchNothing) {
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

TEST(RrtQuartile, NeedsNoGridAndNoTreeForANearGoal) {
  const DistanceField nothing;
  const Footprint footprint(nothing, rover_outline_B(), kMargin_m);
  RrtQuartile search(make_params(), PartContext{});
  SearchReport report;
  const auto pieces = search.find({{0, 0}, 0}, {{2, 0}, 0}, footprint, 0, report);
  ASSERT_TRUE(pieces);
  EXPECT_NEAR(length_m(*pieces), 2.0, 1e-12);
  EXPECT_EQ(report.nodes, 1);
  SearchReport far;
  EXPECT_TRUE(search.find({{0, 0}, 0}, {{-20, 3}, 2.0}, footprint, 0, far));
  EXPECT_GT(far.nodes, 1);
}

TEST(RrtQuartile, SaysWhyThereIsNoWay) {
  const Vineyard vineyard;
  const Site site(vineyard.make());
  const auto reason = [&](const Pose2& from, const Pose2& to, RrtQuartileParams params) {
    return find(site, from, to, params).pieces.reason();
  };
  RrtQuartileParams params = make_params();
  EXPECT_EQ(reason({{10, 1.25}, 0.0}, vineyard.entry(1), params),
            "the start at (10.00, 1.25) heading 0.0 deg is taken: 0.000 m of room, the margin is "
            "0.050 m");
  EXPECT_EQ(reason(vineyard.exit(0), {{10, 3.75}, kPi}, params),
            "the goal at (10.00, 3.75) heading 180.0 deg is taken: 0.000 m of room, the margin is "
            "0.050 m");
  EXPECT_EQ(reason(vineyard.exit(0), {{10, 7.0}, kPi}, params),
            "no free ground as wide as the vehicle joins start and goal");
  params.max_iterations = 50;
  const Found stopped = find(site, vineyard.exit(0), vineyard.entry(1), params);
  EXPECT_EQ(stopped.report.iterations, 50);
  EXPECT_EQ(stopped.pieces.reason(), "not found within max_iterations = 50: the tree has " +
                                         std::to_string(stopped.report.nodes) +
                                         " nodes and 50 of them were expanded");
}

}  // namespace
}  // namespace vinerow
