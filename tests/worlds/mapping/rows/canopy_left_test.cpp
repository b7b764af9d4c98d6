/// Canopy in no row, from painted boxes.

#include "worlds/mapping/rows/canopy_left.h"

#include <gtest/gtest.h>

#include "tests/worlds/mapping/rows/painted_rows.h"

namespace vinerow::mapping::canopy_left_test {
namespace {

using Eigen::Vector2d;
using test::paint_box;

std::vector<CanopyLeft> left_of_row(const CanopyRaster& raster, double min_m2) {
  const std::vector<RowCurve> rows{RowCurve({Vector2d(5.0, 5.0), Vector2d(55.0, 5.0)})};
  return find_canopy_left(raster, RowLocator(rows, {1.5}), min_m2);
}

TEST(CanopyLeft, PiecesBesideTheRowsByFallingArea) {
  CanopyRaster raster = test::empty_raster(60.0, 30.0);
  test::paint_row(raster, 5.0, 55.0, 5.0);
  paint_box(raster, 10.0, 14.0, 20.0, 22.0);  // 8 m2
  paint_box(raster, 40.0, 44.0, 20.0, 25.0);  // 20 m2
  paint_box(raster, 30.0, 31.0, 12.0, 13.0);  // 1 m2: below the limit
  const std::vector<CanopyLeft> left = left_of_row(raster, 3.0);
  ASSERT_EQ(left.size(), 2u);
  EXPECT_NEAR(left[0].area_m2, 20.0, 1e-9);
  EXPECT_NEAR(left[1].area_m2, 8.0, 1e-9);
  // Bounds in squares of 2 m.
  EXPECT_EQ(left[0].low, Vector2d(40.0, 20.0));
  EXPECT_EQ(left[0].high, Vector2d(44.0, 26.0));
  EXPECT_EQ(left[1].middle(), Vector2d(12.0, 21.0));
  EXPECT_EQ(left_of_row(raster, 0.5).size(), 3u);
}

TEST(CanopyLeft, GapsOfAMetreJoinAndGapsOfFiveDoNot) {
  for (const double pitch_m : {2.0, 6.0}) {
    // Nine bushes of 1 m x 1 m.
    CanopyRaster raster = test::empty_raster(60.0, 30.0);
    for (int k = 0; k < 9; ++k) {
      paint_box(raster, 2.0 + pitch_m * k, 3.0 + pitch_m * k, 20.0, 21.0);
    }
    EXPECT_EQ(left_of_row(raster, 0.5).size(), pitch_m < 3.0 ? 1u : 9u);
  }
}

TEST(CanopyLeft, CornersTouchAndLeavesDoNot) {
  CanopyRaster raster = test::empty_raster(60.0, 30.0);
  paint_box(raster, 10.0, 12.0, 20.0, 22.0);
  paint_box(raster, 12.0, 14.0, 22.0, 24.0);
  EXPECT_EQ(left_of_row(raster, 0.5).size(), 1u);
  // 0.09 m2 in the square between two bushes joins nothing, 0.16 m2 does.
  for (const double leaf_m : {0.3, 0.4}) {
    CanopyRaster two = test::empty_raster(60.0, 30.0);
    paint_box(two, 10.0, 12.0, 20.0, 22.0);
    paint_box(two, 12.5, 12.5 + leaf_m, 20.5, 20.5 + leaf_m);
    paint_box(two, 14.0, 16.0, 20.0, 22.0);
    EXPECT_EQ(left_of_row(two, 0.5).size(), leaf_m > 0.35 ? 1u : 2u);
  }
}

}  // namespace
}  // namespace vinerow::mapping::canopy_left_test
