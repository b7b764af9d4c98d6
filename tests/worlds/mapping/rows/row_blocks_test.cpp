/// Blocks of lines whose places are given.

#include "worlds/mapping/rows/row_blocks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::mapping::row_blocks_test {
namespace {

using Eigen::Vector2d;

/// From (x, y) over `length_m` in a direction from x.
RowCurve line(double x, double y, double length_m, double angle_deg = 90.0) {
  const Vector2d u(std::cos(rad_from_deg(angle_deg)), std::sin(rad_from_deg(angle_deg)));
  return RowCurve({Vector2d(x, y), Vector2d(x, y) + length_m * u});
}

RowBlocks split(const std::vector<RowCurve>& lines) {
  return split_blocks(lines, std::vector<double>(lines.size(), 2.5));
}

TEST(RowBlocks, RowsSideBySideAreOneBlockInOrder) {
  const RowBlocks found = split({line(5.0, 0.0, 40.0), line(0.0, 0.0, 40.0), line(2.5, 0.0, 40.0)});
  ASSERT_EQ(found.blocks.size(), 1u);
  EXPECT_TRUE(found.lone.empty());
  ASSERT_EQ(found.blocks[0].rows.size(), 3u);
  EXPECT_DOUBLE_EQ(found.blocks[0].length_m(), 120.0);
  EXPECT_DOUBLE_EQ(found.blocks[0].spacing_m, 2.5);
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_NEAR(
        (found.blocks[0].rows[k].points_W()[0] - found.blocks[0].rows[k - 1].points_W()[0]).norm(),
        2.5, 1e-12);
  }
}

/// Number of blocks and of lone lines of two pairs of rows.
std::pair<std::size_t, std::size_t> counts_of(const std::vector<RowCurve>& lines) {
  const RowBlocks found = split(lines);
  return {found.blocks.size(), found.lone.size()};
}

TEST(RowBlocks, OneMissingRowDoesNotDivideAndTwoDo) {
  const auto pairs_apart = [](double apart_m) {
    return counts_of({line(0.0, 0.0, 40.0), line(2.5, 0.0, 40.0), line(2.5 + apart_m, 0.0, 40.0),
                      line(5.0 + apart_m, 0.0, 40.0)});
  };
  EXPECT_EQ(pairs_apart(5.0), std::pair(std::size_t{1}, std::size_t{0}));
  EXPECT_EQ(pairs_apart(7.5), std::pair(std::size_t{2}, std::size_t{0}));
}

TEST(RowBlocks, AnotherDirectionIsAnotherBlock) {
  const auto turned = [](double angle_deg) {
    return counts_of({line(0.0, 0.0, 40.0), line(2.5, 0.0, 40.0),
                      line(5.0, 0.0, 40.0, 90.0 - angle_deg),
                      line(7.5, 0.0, 40.0, 90.0 - angle_deg)})
        .first;
  };
  EXPECT_EQ(turned(5.0), 1u);
  EXPECT_EQ(turned(7.0), 2u);
}

TEST(RowBlocks, RowsBesideEachOtherForAQuarterAreOfOneBlock) {
  const auto shifted = [](double shift_m) {
    return counts_of({line(0.0, 0.0, 40.0), line(2.5, shift_m, 40.0)});
  };
  EXPECT_EQ(shifted(28.0), std::pair(std::size_t{1}, std::size_t{0}));
  EXPECT_EQ(shifted(32.0), std::pair(std::size_t{0}, std::size_t{2}));
}

TEST(RowBlocks, PiecesInOneLineAreOneRow) {
  // The second row has a gap of 10 m, and one of its pieces runs the other way.
  const RowBlocks found =
      split({line(0.0, 0.0, 40.0), line(2.5, 0.0, 15.0), line(2.5, 40.0, 15.0, -90.0)});
  ASSERT_EQ(found.blocks.size(), 1u);
  ASSERT_EQ(found.blocks[0].rows.size(), 2u);
  EXPECT_DOUBLE_EQ(found.blocks[0].rows[1].length_m(), 40.0);
  // 0.8 m beside the line is more than 0.3 spacings.
  EXPECT_EQ(split({line(0.0, 0.0, 40.0), line(2.5, 0.0, 15.0), line(3.3, 25.0, 15.0)})
                .blocks[0]
                .rows.size(),
            3u);
}

TEST(RowBlocks, TheLongestBlockComesFirst) {
  const RowBlocks found = split({line(0.0, 0.0, 20.0), line(2.5, 0.0, 20.0), line(50.0, 0.0, 40.0),
                                 line(52.5, 0.0, 40.0), line(100.0, 0.0, 90.0)});
  ASSERT_EQ(found.blocks.size(), 2u);
  EXPECT_DOUBLE_EQ(found.blocks[0].length_m(), 80.0);
  ASSERT_EQ(found.lone.size(), 1u);
  EXPECT_DOUBLE_EQ(found.lone[0].length_m(), 90.0);
}

}  // namespace
}  // namespace vinerow::mapping::row_blocks_test
