/// Tracks through rasters of painted rows: gaps, joins, curves and squares that are taken.

#include "worlds/mapping/rows/row_tracking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/worlds/mapping/rows/painted_rows.h"

namespace vinerow::mapping::row_tracking_test {
namespace {

using Eigen::Vector2d;
using test::paint_row;

/// Window with rows along x through the given y, seen from (x, y[0]).
RowPatch window_at(double x, const std::vector<double>& y) {
  RowPatch patch;
  patch.middle = {x, y.front()};
  patch.spacing_m = 2.5;
  patch.likelihood = 0.8;
  patch.canopy_m2 = 10.0;
  for (const double at : y) patch.offsets_m.push_back(at - y.front());
  return patch;
}

double first_x(const RowTrack& track) {
  return std::min(track.front().x(), track.back().x());
}
double last_x(const RowTrack& track) {
  return std::max(track.front().x(), track.back().x());
}

/// Largest distance between neighbouring points.
double longest_step_m(const RowTrack& track) {
  double longest_m = 0.0;
  for (std::size_t k = 1; k < track.size(); ++k) {
    longest_m = std::max(longest_m, (track[k] - track[k - 1]).norm());
  }
  return longest_m;
}

TEST(RowTracking, FollowsAStraightRowFromEndToEnd) {
  CanopyRaster raster = test::empty_raster(60.0, 10.0);
  paint_row(raster, 10.0, 50.0, 5.0);
  // The seed is 0.3 m off the middle, and its direction 3 degrees.
  RowPatch seed = window_at(30.0, {5.3});
  seed.angle_rad = 3.0 * std::numbers::pi / 180.0;
  const std::vector<RowTrack> tracks = track_rows(raster, {seed}, {});
  ASSERT_EQ(tracks.size(), 1u);
  for (const Vector2d& p : tracks[0]) {
    const double from_seed_m = std::abs(p.x() - 30.0);
    EXPECT_NEAR(p.y(), 5.0, from_seed_m < 8.0 ? 0.3 : 0.05) << p.x();
  }
  // The last step with canopy is at most half a step outside.
  EXPECT_NEAR(first_x(tracks[0]), 10.0, 1.0);
  EXPECT_NEAR(last_x(tracks[0]), 50.0, 1.0);
}

TEST(RowTracking, FollowsAnArc) {
  const double radius_m = 25.0;
  const Vector2d middle(30.0, 30.0);
  CanopyRaster raster = test::empty_raster(60.0, 60.0);
  test::paint(raster, [&](double x, double y) {
    return std::abs((Vector2d(x, y) - middle).norm() - radius_m) < 0.3 && y < 30.0;
  });
  const std::vector<RowTrack> tracks = track_rows(raster, {window_at(30.0, {5.0})}, {});
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_GT(static_cast<double>(tracks[0].size()), 0.9 * std::numbers::pi * radius_m);
  // Canopy 3 m before and behind is 0.18 m off the tangent, and on the inside.
  for (const Vector2d& p : tracks[0]) EXPECT_NEAR((p - middle).norm(), radius_m, 0.15);
}

/// Three rows with a gap in the first one or in all of them.
std::vector<RowTrack> tracks_with_gap(double gap_m, bool is_in_all) {
  CanopyRaster raster = test::empty_raster(80.0, 12.0);
  for (const double y : {3.0, 5.5, 8.0}) {
    if (y > 4.0 && !is_in_all) {
      paint_row(raster, 5.0, 75.0, y);
      continue;
    }
    paint_row(raster, 5.0, 40.0 - 0.5 * gap_m, y);
    paint_row(raster, 40.0 + 0.5 * gap_m, 75.0, y);
  }
  return track_rows(raster, {window_at(20.0, {3.0, 5.5, 8.0}), window_at(60.0, {3.0, 5.5, 8.0})},
                    {});
}

TEST(RowTracking, GapBesideARowThatGoesOnIsCrossed) {
  for (const double gap_m : {2.0, 7.0, 14.0, 22.0}) {
    SCOPED_TRACE(gap_m);
    const std::vector<RowTrack> tracks = tracks_with_gap(gap_m, false);
    ASSERT_EQ(tracks.size(), 3u);
    for (const RowTrack& track : tracks) {
      EXPECT_NEAR(first_x(track), 5.0, 1.0);
      EXPECT_NEAR(last_x(track), 75.0, 1.0);
      // Joined pieces are filled with points.
      EXPECT_LT(longest_step_m(track), 1.5);
    }
  }
}

TEST(RowTracking, GapAcrossAllRowsIsATrackBetweenBlocks) {
  EXPECT_EQ(tracks_with_gap(2.0, true).size(), 3u);
  for (const double gap_m : {6.0, 14.0}) EXPECT_EQ(tracks_with_gap(gap_m, true).size(), 6u);
}

TEST(RowTracking, PiecesFartherApartThanTheLongestJoinStayApart) {
  EXPECT_EQ(tracks_with_gap(28.0, false).size(), 4u);
}

TEST(RowTracking, PiecesOfNeighbouringRowsAreNotJoined) {
  // The second piece is 1.5 m beside the first one's line: more than 0.3 spacings.
  CanopyRaster raster = test::empty_raster(80.0, 12.0);
  paint_row(raster, 5.0, 75.0, 8.0);
  paint_row(raster, 5.0, 33.0, 5.5);
  paint_row(raster, 47.0, 75.0, 4.0);
  const std::vector<RowTrack> tracks =
      track_rows(raster, {window_at(20.0, {5.5, 8.0}), window_at(60.0, {4.0, 8.0})}, {});
  EXPECT_EQ(tracks.size(), 3u);
}

TEST(RowTracking, RowsThatAreTakenAreNotTrackedAgain) {
  CanopyRaster raster = test::empty_raster(60.0, 12.0);
  paint_row(raster, 10.0, 50.0, 4.0);
  paint_row(raster, 10.0, 50.0, 6.5);
  const std::vector<RowPatch> windows = {window_at(20.0, {4.0, 6.5}), window_at(40.0, {4.0, 6.5})};
  EXPECT_EQ(track_rows(raster, windows, {}).size(), 2u);
  TakenSquares taken;
  take_rows(raster, {RowCurve({Vector2d(10.0, 4.0), Vector2d(50.0, 4.0)})}, {}, taken);
  const std::vector<RowTrack> left = track_rows(raster, windows, {}, taken);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_NEAR(left[0].front().y(), 6.5, 0.05);
}

TEST(RowTracking, ARowTakesTheSquaresWithinItsReach) {
  const CanopyRaster raster = test::empty_raster(60.0, 12.0);
  TakenSquares taken;
  const RowCurve row({Vector2d(20.0, 6.0), Vector2d(40.0, 6.0)});
  take_rows(raster, {row}, {}, taken);
  ASSERT_EQ(taken.size(), raster.weights.size());
  for (int j = 0; j < raster.rows; ++j) {
    for (int i = 0; i < raster.columns; ++i) {
      double away_m = 0.0;
      row.nearest_s_m(raster.middle_of(i, j), &away_m);
      const bool is_taken = taken[static_cast<std::size_t>(j) * raster.columns + i] != 0;
      // Circles of 0.4 spacings every 0.5 m leave notches of 0.03 m.
      if (away_m >= 0.96 && away_m <= 1.0) continue;
      EXPECT_EQ(is_taken, away_m < 1.0) << raster.middle_of(i, j).transpose();
    }
  }
}

}  // namespace
}  // namespace vinerow::mapping::row_tracking_test
