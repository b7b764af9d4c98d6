/// Row lines fitted to rasters of painted rows: middles, ends, and what is no row.

#include "worlds/mapping/rows/row_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/worlds/mapping/rows/painted_rows.h"

namespace vinerow::mapping::row_lines_test {
namespace {

using Eigen::Vector2d;
using test::paint_box;
using test::paint_row;

constexpr double kSquare_m = 0.1;  // also the bins in which ends are found

/// Rough track along x with an error of 0.2 m across it.
RowTrack track_along(double from_x, double to_x, double y) {
  RowTrack track;
  for (double x = from_x; x <= to_x; x += 1.0) {
    track.emplace_back(x, y + 0.2 * std::sin(2.0 * x));
  }
  return track;
}

/// Row of a raster with a whole row of 40 m at y = 7.5 beside the one at y = 5.
std::vector<RowCurve> fit_beside_whole_row(CanopyRaster& raster, const RowTrack& track) {
  paint_row(raster, 10.0, 50.0, 7.5);
  std::vector<RowCurve> rows =
      fit_row_lines(raster, {track, track_along(10.0, 50.0, 7.5)}, {.spacing_m = 2.5});
  std::erase_if(rows, [](const RowCurve& row) { return row.points_W().front().y() > 6.25; });
  return rows;
}

TEST(RowLines, StraightRowIsTheMiddleOfItsStripWithTwoPoints) {
  CanopyRaster raster = test::empty_raster(60.0, 15.0);
  paint_row(raster, 10.0, 50.0, 5.0);
  const std::vector<RowCurve> rows = fit_beside_whole_row(raster, track_along(11.0, 49.0, 5.0));
  ASSERT_EQ(rows.size(), 1u);
  ASSERT_EQ(rows[0].points_W().size(), 2u);
  for (const Vector2d& p : rows[0].points_W()) EXPECT_NEAR(p.y(), 5.0, 1e-6);
  const double ends_m[] = {rows[0].points_W()[0].x(), rows[0].points_W()[1].x()};
  EXPECT_NEAR(std::min(ends_m[0], ends_m[1]), 10.0, kSquare_m);
  EXPECT_NEAR(std::max(ends_m[0], ends_m[1]), 50.0, kSquare_m);
}

/// Row along an arc about (30, radius + 5) that bends to the left, and its neighbour outside.
std::vector<RowCurve> fit_arcs(double radius_m) {
  CanopyRaster raster = test::empty_raster(60.0, 22.0);
  const Vector2d middle(30.0, radius_m + 5.0);
  test::paint(raster, [&](double x, double y) {
    const double r = (Vector2d(x, y) - middle).norm();
    const bool is_row = std::abs(r - radius_m) < 0.3 || std::abs(r - radius_m - 2.5) < 0.3;
    return is_row && std::abs(x - 30.0) < 20.0;
  });
  std::vector<RowTrack> tracks(2);
  for (double x = -19.0; x <= 19.0; x += 1.0) {
    for (const int k : {0, 1}) {
      const double r = radius_m + 2.5 * k;
      tracks[static_cast<std::size_t>(k)].emplace_back(30.0 + x,
                                                       middle.y() - std::sqrt(r * r - x * x) + 0.1);
    }
  }
  return fit_row_lines(raster, tracks, {.spacing_m = 2.5});
}

TEST(RowLines, CurvedRowFollowsItsArc) {
  const double radius_m = 40.0;
  const std::vector<RowCurve> rows = fit_arcs(radius_m);
  ASSERT_EQ(rows.size(), 2u);
  for (const RowCurve& row : rows) {
    EXPECT_GT(row.points_W().size(), 15u);
    const double own_m = (row.point_W(0.5 * row.length_m()) - Vector2d(30.0, 45.0)).norm();
    const double wanted_m = std::abs(own_m - radius_m) < 1.0 ? radius_m : radius_m + 2.5;
    for (double s_m = 0.0; s_m <= row.length_m(); s_m += 0.5) {
      const double off_m = (row.point_W(s_m) - Vector2d(30.0, 45.0)).norm() - wanted_m;
      // A chord of 2 m is 12 mm off the arc. A parabola has no bias of second order. At an end a
      // straight line is fitted to the 8 m on one side: with the weights (1 - (x / 8 m)^2)^2 it is
      // 0.0886 (8 m)^2 / 2R = 7 cm outside the arc there, and rises by 7.4 cm/m from it.
      const bool is_end = s_m < 5.0 || s_m > row.length_m() - 5.0;
      EXPECT_LT(std::abs(off_m), is_end ? 0.15 : 0.02) << s_m;
    }
  }
}

TEST(RowLines, SlightBendsAreStraight) {
  // y = s^2 / 2R about its line: the outer 10 m of 40 m have the mean (233 - 133) m2 / 2R, 2.5 cm
  // for 2000 m and 12.5 cm for 400 m; 6 cm divides them.
  for (const RowCurve& row : fit_arcs(2000.0)) EXPECT_EQ(row.points_W().size(), 2u);
  const std::vector<RowCurve> bent = fit_arcs(400.0);
  ASSERT_EQ(bent.size(), 2u);
  for (const RowCurve& row : bent) EXPECT_GT(row.points_W().size(), 15u);
}

TEST(RowLines, VineBehindTheLastOneIsTheEndAndAPostIsNot) {
  for (const double piece_m : {0.3, 1.0}) {
    SCOPED_TRACE(piece_m);
    CanopyRaster raster = test::empty_raster(60.0, 15.0);
    paint_row(raster, 10.0, 45.0, 5.0);
    paint_row(raster, 46.0, 46.0 + piece_m, 5.0);
    const std::vector<RowCurve> rows = fit_beside_whole_row(raster, track_along(11.0, 44.0, 5.0));
    ASSERT_EQ(rows.size(), 1u);
    const double end_x = std::max(rows[0].points_W().front().x(), rows[0].points_W().back().x());
    EXPECT_NEAR(end_x, piece_m > 0.6 ? 47.0 : 45.0, 2.0 * kSquare_m);
  }
}

TEST(RowLines, HedgeAcrossTheAlleyEndsARow) {
  CanopyRaster raster = test::empty_raster(60.0, 15.0);
  paint_row(raster, 10.0, 40.0, 5.0);
  paint_box(raster, 40.0, 43.0, 0.5, 6.2);
  const std::vector<RowCurve> rows = fit_beside_whole_row(raster, track_along(11.0, 42.0, 5.0));
  ASSERT_EQ(rows.size(), 1u);
  const double end_x = std::max(rows[0].points_W().front().x(), rows[0].points_W().back().x());
  EXPECT_NEAR(end_x, 40.0, 0.5);
}

TEST(RowLines, RowNeedsCanopyOnNearlyHalfOfItsLength) {
  for (const double canopy_m : {3.0, 5.0}) {
    // Pieces every 9 m: a third or more than half of the metres.
    CanopyRaster raster = test::empty_raster(60.0, 15.0);
    for (double x = 10.0; x < 50.0; x += 9.0) paint_row(raster, x, x + canopy_m, 5.0);
    const std::vector<RowCurve> rows = fit_beside_whole_row(raster, track_along(11.0, 48.0, 5.0));
    EXPECT_EQ(rows.size(), canopy_m > 4.0 ? 1u : 0u) << canopy_m;
  }
}

TEST(RowLines, ALineThroughBushesIsNoRow) {
  // A strip with as much canopy at 0.4 to 0.6 spacings as on it.
  CanopyRaster raster = test::empty_raster(60.0, 15.0);
  paint_box(raster, 10.0, 50.0, 3.4, 6.2);
  EXPECT_TRUE(fit_beside_whole_row(raster, track_along(11.0, 49.0, 5.0)).empty());
}

TEST(RowLines, RowNeedsANeighbourAboutASpacingAway) {
  for (const double apart_m : {2.5, 3.8, 5.0}) {
    CanopyRaster raster = test::empty_raster(60.0, 15.0);
    paint_row(raster, 10.0, 50.0, 5.0);
    paint_row(raster, 10.0, 50.0, 5.0 + apart_m);
    const std::vector<RowCurve> rows = fit_row_lines(
        raster, {track_along(11.0, 49.0, 5.0), track_along(11.0, 49.0, 5.0 + apart_m)},
        {.spacing_m = 2.5});
    EXPECT_EQ(rows.size(), apart_m < 1.6 * 2.5 ? 2u : 0u) << apart_m;
  }
}

TEST(RowLines, ShortRowsAreLeftOut) {
  for (const double low_m : {7.0, 9.0}) {
    CanopyRaster raster = test::empty_raster(60.0, 15.0);
    for (const double y : {5.0, 7.5}) paint_row(raster, 10.0, 18.0, y);
    const std::vector<RowCurve> rows =
        fit_row_lines(raster, {track_along(10.0, 18.0, 5.0), track_along(10.0, 18.0, 7.5)},
                      {.spacing_m = 2.5, .length_low_m = low_m});
    EXPECT_EQ(rows.size(), low_m < 8.0 ? 2u : 0u);
  }
}

TEST(RowLines, BlocksRunNorthAndCountFromTheLeft) {
  // Rows along y in any order, some from north to south.
  const auto row = [](double x, double from_y, double to_y) {
    return RowCurve({Vector2d(x, from_y), Vector2d(x, to_y)});
  };
  const std::vector<RowCurve> rows =
      order_block({row(5.0, 30.0, 0.0), row(0.0, 0.0, 20.0), row(2.5, 25.0, 0.0)});
  ASSERT_EQ(rows.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(rows[k].points_W().front(), Vector2d(2.5 * static_cast<double>(k), 0.0));
    EXPECT_GT(rows[k].direction_W(0.0).y(), 0.0);
  }
}

}  // namespace
}  // namespace vinerow::mapping::row_lines_test
