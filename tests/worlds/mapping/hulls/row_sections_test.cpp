/// Rows of evenly spaced points: their stretches, gaps, slices and strays, all of them counted.

#include "worlds/mapping/hulls/row_sections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vinerow::mapping::row_sections_test {
namespace {

using Eigen::Vector3f;

RowCanopy empty_row(double length_m) {
  return {0, RowCurve({Eigen::Vector2d(0, 0), Eigen::Vector2d(length_m, 0)}), {}};
}

/// Points on the upright sides of a wall of 0.6 m from z = 0.6 m to 2 m, `step_m` apart.
/// @param shift  of each layer along the row against the one below, of the step
void add_wall(RowCanopy& row, double from_m, double to_m, double step_m, double shift = 0.0) {
  const int layers = static_cast<int>(std::lround(1.4 / step_m));
  for (int layer = 0; layer < layers; ++layer) {
    const double z = 0.6 + (layer + 0.5) * step_m;
    const double first_m = std::fmod(0.5 + shift * layer, 1.0) * step_m;
    for (double s = from_m + first_m; s < to_m; s += step_m) {
      for (const double y : {-0.3, 0.3}) {
        row.points.push_back(Eigen::Vector3d(s, y, z).cast<float>());
      }
    }
  }
}

std::int64_t points_in(const RowStretches& cut) {
  std::int64_t sum = 0;
  for (const RowStretch& stretch : cut.stretches) {
    sum += static_cast<std::int64_t>(stretch.points.size());
  }
  return sum;
}

TEST(RowSections, AWallIsOneStretchOfEvenSlices) {
  RowCanopy row = empty_row(10.0);
  add_wall(row, 0.0, 10.0, 0.05);
  const RowStretches cut = slice_row(row, {});
  ASSERT_EQ(cut.stretches.size(), 1u);
  const RowStretch& stretch = cut.stretches[0];
  EXPECT_EQ(points_in(cut), static_cast<std::int64_t>(row.points.size()));
  // 2 % of the points within 0.3 m of an end are noise: less than a column of points.
  EXPECT_NEAR(stretch.from_m, 0.025, 1e-6);
  EXPECT_NEAR(stretch.to_m, 9.975, 1e-6);
  EXPECT_EQ(stretch.slices(), static_cast<int>(std::ceil(9.95 / 0.14)));
  ASSERT_EQ(stretch.first.size(), static_cast<std::size_t>(stretch.slices()) + 1);
  EXPECT_EQ(stretch.first.back(), stretch.points.size());
  for (int i = 0; i < stretch.slices(); ++i) {
    for (std::size_t p = stretch.first[i]; p < stretch.first[i + 1]; ++p) {
      EXPECT_GE(stretch.points[p].x(), stretch.knot_m(i) - 1e-5);
      EXPECT_LE(stretch.points[p].x(), stretch.knot_m(i + 1) + 1e-5);
    }
  }
}

TEST(RowSections, SlicesOfASparseRowAreLonger) {
  // 2 x 7 points in 0.2 m are 70 per m: 60 of them take 0.857 m.
  RowCanopy row = empty_row(20.0);
  add_wall(row, 0.0, 20.0, 0.2, 0.6);
  const RowStretches cut = slice_row(row, {});
  ASSERT_EQ(cut.stretches.size(), 1u);
  const double length_m = cut.stretches[0].to_m - cut.stretches[0].from_m;
  const double step_m = 60.0 / (static_cast<double>(row.points.size()) / length_m);
  EXPECT_EQ(cut.stretches[0].slices(), static_cast<int>(std::ceil(length_m / step_m)));
  EXPECT_GT(cut.stretches[0].slice_m(), 0.8);
}

TEST(RowSections, GapsLongerThanTheLimitDivide) {
  RowCanopy row = empty_row(12.0);
  add_wall(row, 0.0, 4.0, 0.05);
  add_wall(row, 4.4, 8.0, 0.05);
  add_wall(row, 8.7, 12.0, 0.05);
  const RowStretches cut = slice_row(row, {});
  ASSERT_EQ(cut.stretches.size(), 2u);
  ASSERT_EQ(cut.gaps_m.size(), 1u);
  EXPECT_NEAR(cut.gaps_m[0].first, 8.0, 0.03);
  EXPECT_NEAR(cut.gaps_m[0].second, 8.7, 0.03);
  EXPECT_EQ(slice_row(row, {.gap_m = 0.3}).stretches.size(), 3u);
}

TEST(RowSections, APostInAGapIsSparseAndAVineIsNot) {
  for (const double piece_m : {0.2, 0.6}) {
    RowCanopy row = empty_row(10.0);
    add_wall(row, 0.0, 4.0, 0.05);
    add_wall(row, 4.6, 4.6 + piece_m, 0.05);
    const auto in_gap = static_cast<std::int64_t>(row.points.size());
    add_wall(row, 5.8, 10.0, 0.05);
    const auto wall = static_cast<std::int64_t>(4.0 / 0.05) * 28 * 2;
    const RowStretches cut = slice_row(row, {});
    EXPECT_EQ(cut.stretches.size(), piece_m > 0.3 ? 3u : 2u) << piece_m;
    EXPECT_EQ(cut.sparse + cut.lone, piece_m > 0.3 ? 0 : in_gap - wall) << piece_m;
  }
}

TEST(RowSections, LonePointsAreSparse) {
  RowCanopy row = empty_row(10.0);
  add_wall(row, 0.0, 10.0, 0.05);
  const auto wall = static_cast<std::int64_t>(row.points.size());
  // Above the row, each alone in 3 x 3 x 3 cells, and two beside each other.
  for (const double s : {2.0, 4.0, 6.0}) row.points.emplace_back(static_cast<float>(s), 0.0f, 3.0f);
  row.points.emplace_back(8.0f, 0.0f, 3.0f);
  row.points.emplace_back(8.01f, 0.0f, 3.0f);
  const RowStretches cut = slice_row(row, {});
  EXPECT_EQ(cut.sparse, 5);
  EXPECT_EQ(points_in(cut), wall);
}

TEST(RowSections, EveryPointIsKeptOrCounted) {
  RowCanopy row = empty_row(10.0);
  add_wall(row, 0.0, 10.0, 0.05);
  const auto wall = static_cast<std::int64_t>(row.points.size());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  row.points.emplace_back(nan, 0.0f, 1.0f);
  row.points.emplace_back(1.0f, std::numeric_limits<float>::infinity(), 1.0f);
  // Beyond an end, beside, below and above what belongs to a row.
  row.points.emplace_back(-10.5f, 0.0f, 1.0f);
  row.points.emplace_back(20.5f, 0.0f, 1.0f);
  row.points.emplace_back(5.0f, 4.5f, 1.0f);
  row.points.emplace_back(5.0f, 0.0f, -2.5f);
  row.points.emplace_back(5.0f, 0.0f, 8.5f);
  const RowStretches cut = slice_row(row, {});
  EXPECT_EQ(cut.not_finite, 2);
  EXPECT_EQ(cut.sparse, 5);
  EXPECT_EQ(points_in(cut), wall);
}

TEST(RowSections, TooFewPointsOrTooShortAPieceGiveNoStretch) {
  RowCanopy few = empty_row(1.0);
  for (int k = 0; k < 20; ++k) few.points.emplace_back(0.05f * static_cast<float>(k), 0.0f, 1.0f);
  const RowStretches none = slice_row(few, {});
  EXPECT_TRUE(none.stretches.empty());
  EXPECT_EQ(none.lone + none.sparse, 20);
  RowCanopy piece = empty_row(1.0);
  add_wall(piece, 0.0, 0.2, 0.02);
  EXPECT_TRUE(slice_row(piece, {}).stretches.empty());
}

TEST(RowSections, PointsBeyondTheEndsBelongToTheOuterSlices) {
  // 1 % of the points of the last 0.3 m are a little beyond it.
  RowCanopy row = empty_row(10.0);
  add_wall(row, 0.0, 10.0, 0.05);
  for (int k = 0; k < 3; ++k)
    row.points.emplace_back(10.03f, 0.3f, 1.0f + 0.05f * static_cast<float>(k));
  const RowStretches cut = slice_row(row, {});
  ASSERT_EQ(cut.stretches.size(), 1u);
  const RowStretch& stretch = cut.stretches[0];
  EXPECT_NEAR(stretch.to_m, 9.975, 1e-6);
  EXPECT_EQ(points_in(cut), static_cast<std::int64_t>(row.points.size()));
  float farthest = 0.0f;
  for (std::size_t p = stretch.first[stretch.slices() - 1]; p < stretch.points.size(); ++p) {
    farthest = std::max(farthest, stretch.points[p].x());
  }
  EXPECT_FLOAT_EQ(farthest, 10.03f);
}

}  // namespace
}  // namespace vinerow::mapping::row_sections_test
