/// A map against the truth, with errors that the test puts in.

#include "worlds/mapping/photogrammetry/map_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::mapping::map_comparison_test {
namespace {

using Eigen::Vector3d;

constexpr double kLength_m = 40.0, kSpacing_m = 2.5;

/// Rows along x, 2.5 m apart; canopy from x = 1 to x = 39.
CloudTruth make_truth(int rows) {
  CloudTruth truth;
  truth.bearing_deg = 90.0;
  truth.spacing_m = kSpacing_m;
  for (int k = 0; k < rows; ++k) {
    const double y = kSpacing_m * k;
    RowTruth row;
    row.row = k;
    row.line_W = {{0, y, 0}, {kLength_m, y, 0}};
    row.first_W = {1, y, 0};
    row.last_W = {kLength_m - 1, y, 0};
    row.length_m = kLength_m - 2;
    row.bearing_deg = 90.0;
    row.canopy_base_m = 0.5;
    row.canopy_top_m = 2.0;
    row.canopy_width_m = 0.6;
    row.volume_m3 = 20.0;
    row.gaps_m = {{10.0, 11.0}};
    truth.rows.push_back(row);
    truth.volume_m3 += row.volume_m3;
  }
  return truth;
}

struct Mapped {
  int id;
  Vector3d first_W, last_W;
};

CloudMap make_map(const std::vector<Mapped>& rows) {
  CloudMap map;
  for (const Mapped& mapped : rows) {
    PlantRow row;
    row.id = mapped.id;
    row.line_W = {mapped.first_W, mapped.last_W};
    map.map.rows.push_back(row);
    MappedRowFigures figures;
    figures.row = mapped.id;
    figures.first_W = mapped.first_W;
    figures.last_W = mapped.last_W;
    const Vector3d along = mapped.last_W - mapped.first_W;
    figures.length_m = along.head<2>().norm();
    figures.bearing_deg = std::atan2(along.x(), along.y()) * 180.0 / std::acos(-1.0);
    figures.canopy_base_m = 0.45;
    figures.canopy_top_m = 2.1;
    figures.canopy_width_m = 0.7;
    figures.volume_m3 = 23.0;
    map.report.rows.push_back(figures);
    map.report.volume_m3 += figures.volume_m3;
  }
  map.report.bearing_deg = 90.5;
  map.report.spacing_m = 2.4;
  map.report.seen_volume_m3 = 0.9 * 20.0 * static_cast<double>(rows.size());
  return map;
}

TEST(MapComparison, EndsAreAsFarOffAsTheyWereMoved) {
  // 3-4-5: the first end 0.3 m along and 0.4 m beside the true one, and 7 m above it, which does
  // not count; the last one 0.2 m along.
  const MapComparison found =
      compare_with_truth(make_map({{5, {1.3, 0.4, 7.0}, {38.8, 0.0, 0.0}}}), make_truth(1));
  ASSERT_EQ(found.rows.size(), 1u);
  EXPECT_EQ(found.rows[0].mapped_row, 5);
  EXPECT_NEAR(found.rows[0].first_m, 0.5, 1e-12);
  EXPECT_NEAR(found.rows[0].last_m, 0.2, 1e-12);
  EXPECT_NEAR(found.worst_end_m(), 0.5, 1e-12);
  EXPECT_NEAR(found.mean_end_m(), 0.35, 1e-12);
}

TEST(MapComparison, ARowThatRunsTheOtherWayIsComparedEndWithItsOwnEnd) {
  const MapComparison found =
      compare_with_truth(make_map({{5, {38.8, 0.0, 0.0}, {1.3, 0.4, 0.0}}}), make_truth(1));
  EXPECT_NEAR(found.rows[0].first_m, 0.5, 1e-12) << "of the truth's first end";
  EXPECT_NEAR(found.rows[0].last_m, 0.2, 1e-12);
  EXPECT_NEAR(found.worst_end_m(), 0.5, 1e-12);
  EXPECT_NEAR(found.mean_end_m(), 0.35, 1e-12);
  // Lines have no direction: what is left of 180 degrees is the 0.4 m over 37.5 m.
  EXPECT_NEAR(found.rows[0].bearing_deg, std::atan2(0.4, 37.5) * 180.0 / std::acos(-1.0), 1e-9);
}

TEST(MapComparison, FiguresAreTheMapsLessTheTrueOnes) {
  const MapComparison found =
      compare_with_truth(make_map({{0, {1, 0, 0}, {37, 0, 0}}}), make_truth(1));
  const RowComparison& row = found.rows[0];
  EXPECT_NEAR(row.length_m, 36.0 - 38.0, 1e-12);
  EXPECT_NEAR(row.base_m, -0.05, 1e-12);
  EXPECT_NEAR(row.top_m, 0.1, 1e-12);
  EXPECT_NEAR(row.width_m, 0.1, 1e-12);
  EXPECT_NEAR(row.volume_share, 0.15, 1e-12);
  EXPECT_EQ(row.gaps, 0);
  EXPECT_EQ(row.true_gaps, 1);
  EXPECT_NEAR(found.bearing_deg, 0.5, 1e-12);
  EXPECT_NEAR(found.spacing_m, -0.1, 1e-12);
  EXPECT_NEAR(found.volume_share, 0.15, 1e-12);
  EXPECT_NEAR(found.seen_volume_share, -0.1, 1e-12);
}

TEST(MapComparison, RowsAreMatchedByPlaceNotByNumber) {
  // Three true rows; the map numbers them backwards, lacks the middle one and has one too many.
  const double far = 2 * kSpacing_m;
  const MapComparison found =
      compare_with_truth(make_map({{0, {1, far + 0.1, 0}, {39, far + 0.1, 0}},
                                   {1, {1, 0.2, 0}, {39, 0.2, 0}},
                                   {2, {1, far + kSpacing_m, 0}, {39, far + kSpacing_m, 0}}}),
                         make_truth(3));
  ASSERT_EQ(found.rows.size(), 3u);
  EXPECT_EQ(found.rows[0].mapped_row, 1);
  EXPECT_EQ(found.rows[1].mapped_row, -1);
  EXPECT_EQ(found.rows[2].mapped_row, 0);
  EXPECT_EQ(found.found(), 2);
  EXPECT_EQ(found.extra_rows, std::vector<int>{2});
  EXPECT_NEAR(found.worst_end_m(), 0.2, 1e-12);
  EXPECT_NEAR(found.mean_end_m(), 0.15, 1e-12) << "of the rows that were found";
}

TEST(MapComparison, ARowWithoutCanopyIsNotAskedFor) {
  CloudTruth truth = make_truth(2);
  truth.rows[1].length_m = 0.0;
  const MapComparison found = compare_with_truth(make_map({{0, {1, 0, 0}, {39, 0, 0}}}), truth);
  ASSERT_EQ(found.rows.size(), 1u);
  EXPECT_EQ(found.worst_end_m(), 0.0);
}

TEST(MapComparison, ARowHalfASpacingAwayIsAnother) {
  const double limit_m = 0.5 * kSpacing_m;
  for (const double offset_m : {limit_m - 0.01, limit_m + 0.01}) {
    const MapComparison found =
        compare_with_truth(make_map({{0, {1, -offset_m, 0}, {39, -offset_m, 0}}}), make_truth(1));
    EXPECT_EQ(found.found(), offset_m < limit_m ? 1 : 0) << offset_m;
  }
}

}  // namespace
}  // namespace vinerow::mapping::map_comparison_test
