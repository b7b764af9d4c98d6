#include "controllers/planning/search/rrt_quartile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/controllers/planning/search/quartile_runs.h"

namespace vinerow::controllers::rrt_quartile_test {
namespace {

using hand_grids::length_m;
using hand_grids::rover_outline_B;
using hand_grids::Vineyard;
using namespace quartile_runs;

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
    for (const PathSegment& piece : *run.pieces) {
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
            "start in collision: at (10.00, 1.25) heading 0.0 deg the footprint has 0.000 m of "
            "clearance, the margin is 0.050 m");
  EXPECT_EQ(reason(vineyard.exit(0), {{10, 3.75}, kPi}, params),
            "goal in collision: at (10.00, 3.75) heading 180.0 deg the footprint has 0.000 m of "
            "clearance, the margin is 0.050 m");
  EXPECT_EQ(reason(vineyard.exit(0), {{10, 300}, kPi}, params),
            "goal in collision: (10.00, 300.00) heading 180.0 deg is outside the map's occupancy "
            "grid");
  EXPECT_EQ(reason(vineyard.exit(0), {{10, 7.0}, kPi}, params),
            "no free ground as wide as the vehicle connects start and goal");
  params.max_iterations = 50;
  const Found stopped = find(site, vineyard.exit(0), vineyard.entry(1), params);
  EXPECT_EQ(stopped.report.iterations, 50);
  EXPECT_EQ(stopped.pieces.reason(), "not found within max_iterations = 50: the tree has " +
                                         std::to_string(stopped.report.nodes) +
                                         " nodes and 50 of them were expanded");
}

}  // namespace
}  // namespace vinerow::controllers::rrt_quartile_test
