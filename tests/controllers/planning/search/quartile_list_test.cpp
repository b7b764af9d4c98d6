#include "controllers/planning/search/quartile_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "controllers/planning/search/pose_cells.h"

namespace vinerow::controllers::quartile_list_test {
namespace {

/// The same rule with sorting: nodes of the lowest quartile that has an open one.
std::set<int> find_candidates(const std::vector<double>& distances, const std::set<int>& open) {
  std::vector<double> sorted = distances;
  std::sort(sorted.begin(), sorted.end());
  for (int q = 1; q <= 4; ++q) {
    const auto count = static_cast<std::size_t>(std::ceil(0.25 * q * sorted.size()));
    const double upper = sorted[count - 1];
    std::set<int> found;
    for (const int node : open) {
      if (distances[node] <= upper) found.insert(node);
    }
    if (!found.empty()) return found;
  }
  return {};
}

TEST(QuartileList, DrawsWhereSortingFindsTheLowestQuartileWithOpenNodes) {
  RandomStream world(3, "", "world"), draws(3, "", "draws");
  QuartileList list(true);
  std::vector<double> distances;
  std::set<int> open;
  for (int step = 0; step < 1500; ++step) {
    // A bucket's middle each, so that buckets and distances have the same order.
    const double distance_m =
        (std::floor(world.uniform(0.0, 200.0)) + 0.5) * QuartileList::kBucket_m;
    const int node = list.add(distance_m);
    ASSERT_EQ(node, step);
    distances.push_back(distance_m);
    open.insert(node);
    // Near ones are closed first, as a search does, so that low quartiles run dry.
    while (open.size() > 40) {
      const int drawn = list.draw(draws);
      ASSERT_EQ(find_candidates(distances, open).count(drawn), 1u) << "step " << step;
      list.close(drawn);
      open.erase(drawn);
    }
    ASSERT_EQ(list.open_count(), static_cast<int>(open.size()));
  }
  while (!open.empty()) {
    const int drawn = list.draw(draws);
    ASSERT_EQ(find_candidates(distances, open).count(drawn), 1u);
    list.close(drawn);
    list.close(drawn);  // twice is allowed
    open.erase(drawn);
  }
  EXPECT_EQ(list.draw(draws), -1);
}

TEST(QuartileList, EveryOpenNodeOfTheQuartileHasTheSameChance) {
  QuartileList list(true);
  for (int i = 0; i < 16; ++i) list.add(1.0 + i);
  list.close(2);
  RandomStream random(1, "", "draws");
  std::map<int, int> times;
  constexpr int kDraws = 9000;
  for (int i = 0; i < kDraws; ++i) ++times[list.draw(random)];
  ASSERT_EQ(times.size(), 3u);  // nodes 0, 1, 3: the lowest four less the closed one
  const double sigma = std::sqrt(kDraws / 3.0 * 2.0 / 3.0);
  for (const int node : {0, 1, 3}) EXPECT_NEAR(times[node], kDraws / 3.0, 5.0 * sigma) << node;
}

TEST(QuartileList, WithoutQuartilesEveryOpenNodeIsDrawn) {
  QuartileList list(false);
  for (int i = 0; i < 16; ++i) list.add(1.0 + i);
  RandomStream random(1, "", "draws");
  std::set<int> drawn;
  for (int i = 0; i < 1000; ++i) drawn.insert(list.draw(random));
  EXPECT_EQ(drawn.size(), 16u);
}

TEST(QuartileList, TakesInfiniteDistances) {
  QuartileList list(true);
  list.add(std::numeric_limits<double>::infinity());
  const int near = list.add(2.0);
  RandomStream random(1, "", "draws");
  EXPECT_EQ(list.draw(random), near);
  list.close(near);
  EXPECT_EQ(list.draw(random), 0);
}

TEST(PoseCells, HoldsWhatAMapHolds) {
  PoseCells cells(0.2, rad_from_deg(8.0));
  std::map<std::uint64_t, int> expected;
  RandomStream random(5, "", "poses");
  for (int i = 0; i < 50000; ++i) {
    const double x = random.uniform(-30, 30), y = random.uniform(-30, 30);
    const std::uint64_t key = cells.key({{x, y}, random.uniform(-10, 10)});
    const auto found = expected.find(key);
    ASSERT_EQ(cells.find(key), found == expected.end() ? -1 : found->second);
    cells.set(key, i);
    expected[key] = i;
  }
  for (const auto& [key, node] : expected) ASSERT_EQ(cells.find(key), node);
}

TEST(PoseCells, CellsAreOfTheSizeAskedAndHeadingsWrap) {
  const PoseCells cells(0.2, rad_from_deg(8.0));
  const Pose2 pose = {{0.31, -0.29}, rad_from_deg(3.0)};
  const auto key = [&](double dx, double dy, double turn_deg) {
    return cells.key({pose.p + Eigen::Vector2d(dx, dy), pose.yaw_rad + rad_from_deg(turn_deg)});
  };
  EXPECT_EQ(key(0, 0, 0), key(0.08, 0.08, 4.9));
  EXPECT_EQ(key(0, 0, 0), key(0, 0, 360));
  EXPECT_EQ(key(0, 0, 0), key(0, 0, -720));
  EXPECT_NE(key(0, 0, 0), key(0.1, 0, 0));
  EXPECT_NE(key(0, 0, 0), key(0, 0.1, 0));
  EXPECT_NE(key(0, 0, 0), key(0, 0, 5.1));
  EXPECT_NE(key(0, 0, 0), key(0, 0, -3.1));
  EXPECT_NE(key(0, 0, 0), key(0, 0, 180));
}

}  // namespace
}  // namespace vinerow::controllers::quartile_list_test
