/// Quantiles and means of histograms filled by hand.

#include "worlds/mapping/hulls/excess_counts.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::mapping::excess_counts_test {
namespace {

/// Index of the step that contains an excess, away from the steps' borders.
int step_of(double excess_m) {
  return static_cast<int>((excess_m - ExcessCounts::kLow_m) / ExcessCounts::kStep_m);
}

/// Adds points of one excess to a side.
void add(ExcessCounts& counts, int side, double excess_m, std::int64_t points) {
  counts.all[static_cast<std::size_t>(step_of(excess_m))] += points;
  counts.by_side[static_cast<std::size_t>(side)][static_cast<std::size_t>(step_of(excess_m))] +=
      points;
}

TEST(ExcessCounts, LevelIsExceededByThatManyPoints) {
  ExcessCounts counts(2);
  add(counts, 0, 0.05025, 3);
  add(counts, 1, 0.02025, 4);
  add(counts, 1, -0.10025, 90);
  EXPECT_NEAR(counts.level_m(0), 0.0505, 1e-12);  // upper end of the step of the outermost points
  EXPECT_NEAR(counts.level_m(2), 0.0505, 1e-12);
  EXPECT_NEAR(counts.level_m(3), 0.0205, 1e-12);
  EXPECT_NEAR(counts.level_m(6), 0.0205, 1e-12);
  EXPECT_NEAR(counts.level_m(7), -0.1, 1e-12);
  EXPECT_EQ(counts.level_m(97), ExcessCounts::kLow_m);
}

TEST(ExcessCounts, QuantilesAreOfOneSide) {
  ExcessCounts counts(2);
  for (int k = 0; k < 10; ++k) add(counts, 0, 0.01 * k + 0.00025, 1);
  add(counts, 1, 0.3, 1000);
  EXPECT_EQ(counts.count(0), 10);
  EXPECT_EQ(counts.count(1), 1000);
  EXPECT_NEAR(counts.share_m(0, 0.1), 0.00025, 1e-9);
  EXPECT_NEAR(counts.share_m(0, 0.5), 0.04025, 1e-9);
  EXPECT_NEAR(counts.share_m(0, 1.0), 0.09025, 1e-9);
  EXPECT_TRUE(std::isnan(ExcessCounts(2).share_m(0, 0.5)));
}

TEST(ExcessCounts, MiddleIsTheMeanWithoutTheOuterTwentieths) {
  ExcessCounts counts(1);
  // 90 points from 0.001 to 0.09 m, 4 far in and 4 far out.
  for (int k = 1; k <= 90; ++k) add(counts, 0, 0.001 * k + 0.00025, 1);
  add(counts, 0, -0.29, 4);
  add(counts, 0, 0.5, 4);
  EXPECT_NEAR(counts.middle_m(0), 0.0455 + 0.00025, 1e-9);
  EXPECT_TRUE(std::isnan(ExcessCounts(1).middle_m(0)));
}

TEST(ExcessCounts, SumsAddUp) {
  ExcessCounts a(2), b(2);
  add(a, 0, 0.05025, 3);
  add(b, 0, 0.05025, 4);
  add(b, 1, 0.01025, 5);
  a.add(b);
  EXPECT_EQ(a.count(0), 7);
  EXPECT_EQ(a.count(1), 5);
  EXPECT_NEAR(a.level_m(6), 0.0505, 1e-12);
  EXPECT_NEAR(a.level_m(7), 0.0105, 1e-12);
}

}  // namespace
}  // namespace vinerow::mapping::excess_counts_test
