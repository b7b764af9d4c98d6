/// Ranges of heights against all samples of a rectangle, one by one.

#include "engine/physics/height_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/api/height_field.h"
#include "engine/core/random.h"

namespace vinerow::physics::height_ranges_test {
namespace {

HeightField make_rough(int columns, int rows, RandomStream& random) {
  HeightField field;
  field.columns = columns;
  field.rows = rows;
  field.cell_m = 1.0;
  for (int k = 0; k < columns * rows; ++k) {
    field.heights_m.push_back(static_cast<float>(random.uniform(-5, 5)));
  }
  return field;
}

/// Of the samples on and inside the squares of level 0 from (i0, j0) to (i1, j1).
HeightRanges::Range of_samples(const HeightField& field, int i0, int j0, int i1, int j1) {
  constexpr int kCells = HeightRanges::kCells;
  HeightRanges::Range range{1e9f, -1e9f};
  for (int j = j0 * kCells; j <= std::min((j1 + 1) * kCells, field.rows - 1); ++j) {
    for (int i = i0 * kCells; i <= std::min((i1 + 1) * kCells, field.columns - 1); ++i) {
      const float h_m = field.heights_m[static_cast<std::size_t>(j * field.columns + i)];
      range = {std::min(range.low_m, h_m), std::max(range.high_m, h_m)};
    }
  }
  return range;
}

TEST(HeightRanges, BoundAllSamplesOfARectangleByThoseOfFewSquares) {
  RandomStream random(3, "test", "height_ranges");
  for (const auto& [columns, rows] : {std::pair{2, 2}, {5, 5}, {6, 33}, {97, 64}, {130, 11}}) {
    const HeightField field = make_rough(columns, rows, random);
    const HeightRanges ranges(field);
    const auto all = of_samples(field, 0, 0, ranges.columns() - 1, ranges.rows() - 1);
    EXPECT_EQ(ranges.all().low_m, all.low_m);
    EXPECT_EQ(ranges.all().high_m, all.high_m);
    const auto square = [&](int count) {
      const int a = static_cast<int>(random.uniform() * count);
      const int b = static_cast<int>(random.uniform() * count);
      return std::pair(std::min(a, b), std::max(a, b));
    };
    for (int k = 0; k < 500; ++k) {
      const auto i = square(ranges.columns()), j = square(ranges.rows());
      const HeightRanges::Range bound = ranges.of(i.first, j.first, i.second, j.second);
      const auto inside = of_samples(field, i.first, j.first, i.second, j.second);
      EXPECT_LE(bound.low_m, inside.low_m);
      EXPECT_GE(bound.high_m, inside.high_m);
      // At most two squares a side, each less than twice as wide as the rectangle's longer side.
      const int wide = 2 * std::max(i.second - i.first, j.second - j.first) + 1;
      const auto around =
          of_samples(field, std::max(0, i.first - wide), std::max(0, j.first - wide),
                     std::min(ranges.columns() - 1, i.second + wide),
                     std::min(ranges.rows() - 1, j.second + wide));
      EXPECT_GE(bound.low_m, around.low_m);
      EXPECT_LE(bound.high_m, around.high_m);
      // Small ones are exact.
      if (i.second - i.first <= 1 && j.second - j.first <= 1) {
        EXPECT_EQ(bound.low_m, inside.low_m);
        EXPECT_EQ(bound.high_m, inside.high_m);
      }
    }
  }
}

TEST(HeightRanges, AboveThePlaneOfASlopeTheyAreThoseOfWhatStandsOnIt) {
  RandomStream random(5, "test", "height_ranges");
  HeightField field = make_rough(61, 45, random);
  const HeightField rough = field;
  const Eigen::Vector2d tilt_m(0.37, -1.9);
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      field.heights_m[static_cast<std::size_t>(j * field.columns + i)] +=
          static_cast<float>(tilt_m.x() * i + tilt_m.y() * j);
    }
  }
  const HeightRanges on_slope(field, tilt_m), level(rough);
  for (int j = 0; j < level.rows(); ++j) {
    for (int i = 0; i < level.columns(); ++i) {
      // But for the heights' own rounding.
      EXPECT_NEAR(on_slope.of(i, j, i, j).low_m, level.of(i, j, i, j).low_m, 1e-5);
      EXPECT_NEAR(on_slope.of(i, j, i, j).high_m, level.of(i, j, i, j).high_m, 1e-5);
      for (int n = j * 4; n <= std::min(j * 4 + 4, field.rows - 1); ++n) {
        for (int m = i * 4; m <= std::min(i * 4 + 4, field.columns - 1); ++m) {
          const double above_m =
              double{1} * field.heights_m[static_cast<std::size_t>(n * field.columns + m)] -
              (tilt_m.x() * m + tilt_m.y() * n);
          ASSERT_LE(on_slope.of(i, j, i, j).low_m, above_m);
          ASSERT_GE(on_slope.of(i, j, i, j).high_m, above_m);
        }
      }
    }
  }
}

TEST(HeightRanges, SquaresAboveTheLastLevelAreTheWholeField) {
  RandomStream random(4, "test", "height_ranges");
  const HeightField field = make_rough(40, 21, random);
  const HeightRanges ranges(field);
  const auto all = ranges.square(20, 0, 0);
  EXPECT_EQ(all.low_m, ranges.all().low_m);
  EXPECT_EQ(all.high_m, ranges.all().high_m);
  const auto one = ranges.square(2, 1, 0);  // 16 cells wide
  const auto samples = of_samples(field, 4, 0, 7, 3);
  EXPECT_EQ(one.low_m, samples.low_m);
  EXPECT_EQ(one.high_m, samples.high_m);
}

}  // namespace
}  // namespace vinerow::physics::height_ranges_test
