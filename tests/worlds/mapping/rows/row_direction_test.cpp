/// Direction and spacing of painted rows in one window, and the windows that make a parcel.

#include "worlds/mapping/rows/row_direction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "tests/worlds/mapping/rows/painted_rows.h"

namespace vinerow::mapping::row_direction_test {
namespace {

using Eigen::Vector2d;

/// Raster of 20 m x 20 m, one window, with rows of 0.6 m through its middle plus `shift_m`.
CanopyRaster rows_at(double angle_rad, double spacing_m, double shift_m) {
  CanopyRaster raster = test::empty_raster(20.0, 20.0);
  const Vector2d n(-std::sin(angle_rad), std::cos(angle_rad));
  test::paint(raster, [&](double x, double y) {
    const double across_m = n.dot(Vector2d(x - 10.0, y - 10.0)) - shift_m;
    return std::abs(std::remainder(across_m, spacing_m)) < 0.3;
  });
  return raster;
}

/// The window around the middle of a raster of 20 m.
RowPatch middle_window(const CanopyRaster& raster) {
  for (const RowPatch& patch : find_row_patches(raster, {.radius_m = 20.0})) return patch;
  return {};
}

TEST(RowDirection, AngleSpacingAndOffsetsOfPaintedRows) {
  for (const double angle_deg : {0.0, 17.3, 45.0, 90.0, 131.7, 179.0}) {
    for (const double spacing_m : {1.8, 2.5, 3.1}) {
      SCOPED_TRACE(::testing::Message() << angle_deg << " deg, " << spacing_m << " m");
      const RowPatch patch = middle_window(rows_at(rad_from_deg(angle_deg), spacing_m, 0.37));
      const double off_rad = std::remainder(patch.angle_rad - rad_from_deg(angle_deg), kPi);
      // The search ends with steps of 0.04 degrees. Along the axes all squares of a line share one
      // place between two bins, so that the sharpest profile is a little off the axis.
      const bool is_axis = std::fmod(angle_deg, 90.0) == 0.0;
      EXPECT_LT(std::abs(deg_from_rad(off_rad)), is_axis ? 0.3 : 0.1);
      EXPECT_NEAR(patch.spacing_m, spacing_m, 0.03);
      EXPECT_GT(patch.likelihood, 0.5);
      EXPECT_GE(patch.offsets_m.size(), 5u);
      const double turned = std::cos(patch.angle_rad - rad_from_deg(angle_deg));
      for (const double offset_m : patch.offsets_m) {
        const double row_m = turned > 0.0 ? offset_m : -offset_m;
        EXPECT_NEAR(std::remainder(row_m - 0.37, spacing_m), 0.0, 0.06) << offset_m;
      }
    }
  }
}

TEST(RowDirection, CanopyAreaIsThatOfTheSquares) {
  CanopyRaster raster = rows_at(0.0, 2.5, 0.0);
  double wanted_m2 = 0.0;
  for (const float weight : raster.weights) wanted_m2 += 0.01 * weight;
  EXPECT_NEAR(middle_window(raster).canopy_m2, wanted_m2, 1e-6);
}

TEST(RowDirection, OneRowHasNoSpacingAndBareGroundNoWindow) {
  CanopyRaster raster = test::empty_raster(20.0, 20.0);
  EXPECT_TRUE(find_row_patches(raster, {}).empty());
  test::paint_row(raster, 0.0, 20.0, 10.0);
  const RowPatch one = middle_window(raster);
  EXPECT_EQ(one.likelihood, 0.0);
  EXPECT_EQ(one.spacing_m, 0.0);
  EXPECT_GT(one.canopy_m2, 0.0);
}

TEST(RowDirection, SpacingOutsideTheLimitsIsNotFound) {
  const CanopyRaster raster = rows_at(0.0, 2.5, 0.0);
  const auto spacing_of = [&](double low_m, double high_m) {
    return find_row_patches(raster,
                            {.radius_m = 20.0, .spacing_low_m = low_m, .spacing_high_m = high_m})
        .front()
        .spacing_m;
  };
  EXPECT_NEAR(spacing_of(1.0, 6.0), 2.5, 0.03);
  // Twice the spacing is the first peak above 3 m.
  EXPECT_NEAR(spacing_of(3.0, 6.0), 5.0, 0.03);
  EXPECT_EQ(spacing_of(1.0, 2.0), 0.0);
}

TEST(RowDirection, WindowsAreARadiusApart) {
  CanopyRaster raster = test::empty_raster(30.0, 20.0);
  test::paint(raster, [](double, double) { return true; });
  const std::vector<RowPatch> patches = find_row_patches(raster, {});
  ASSERT_EQ(patches.size(), 6u);
  EXPECT_EQ(patches[0].middle, Vector2d(5.0, 5.0));
  EXPECT_EQ(patches[1].middle, Vector2d(15.0, 5.0));
  EXPECT_EQ(patches[3].middle, Vector2d(5.0, 15.0));
}

RowPatch window(double x, double y, double angle_deg, double spacing_m, double likelihood,
                double canopy_m2 = 10.0) {
  return {{x, y}, rad_from_deg(angle_deg), spacing_m, likelihood, canopy_m2, {}};
}

TEST(RowDirection, MedianSpacingWeighsLikelihoodTimesCanopy) {
  EXPECT_EQ(median_spacing_m({window(0, 0, 0, 2.0, 0.5, 10.0), window(0, 0, 0, 3.0, 0.5, 10.0),
                              window(0, 0, 0, 4.0, 0.5, 10.0)}),
            3.0);
  // 4 + 1 against 6.
  EXPECT_EQ(median_spacing_m({window(0, 0, 0, 4.0, 0.6, 10.0), window(0, 0, 0, 2.0, 0.2, 20.0),
                              window(0, 0, 0, 3.0, 0.1, 10.0)}),
            4.0);
}

/// Nine windows of one direction, 10 m apart.
std::vector<RowPatch> parcel(double angle_deg, double spacing_m) {
  std::vector<RowPatch> patches;
  for (int k = 0; k < 9; ++k) {
    patches.push_back(window(10.0 * (k % 3), 10.0 * (k / 3), angle_deg, spacing_m, 0.5));
  }
  return patches;
}

TEST(RowDirection, WindowsAgreeAcrossTheAxisWrap) {
  // 179 and 1 degrees are 2 degrees apart.
  std::vector<RowPatch> patches = parcel(1.0, 2.5);
  patches[4].angle_rad = rad_from_deg(179.0);
  EXPECT_EQ(consistent_windows(patches, {}).size(), 9u);
}

TEST(RowDirection, WindowsThatDisagreeAreLeftOut) {
  const auto with_middle = [](double angle_deg, double spacing_m, double likelihood) {
    std::vector<RowPatch> patches = parcel(30.0, 2.5);
    patches[4] = window(10.0, 10.0, angle_deg, spacing_m, likelihood);
    return consistent_windows(patches, {}).size();
  };
  EXPECT_EQ(with_middle(30.0, 2.5, 0.5), 9u);
  EXPECT_EQ(with_middle(30.0 + 14.0, 2.5, 0.5), 9u);  // within 15 degrees
  EXPECT_EQ(with_middle(30.0 + 16.0, 2.5, 0.5), 8u);
  EXPECT_EQ(with_middle(30.0, 1.9, 0.5), 9u);  // 0.75 times the spacing is 1.875
  EXPECT_EQ(with_middle(30.0, 1.8, 0.5), 8u);
  EXPECT_EQ(with_middle(30.0, 3.3, 0.5), 9u);  // 1.33 times is 3.325
  EXPECT_EQ(with_middle(30.0, 3.4, 0.5), 8u);
  EXPECT_EQ(with_middle(30.0, 2.5, 0.1), 8u);  // not likely
}

TEST(RowDirection, AWindowNeedsTwoFifthsOfTheCanopyAroundIt) {
  for (const int parallel : {3, 4}) {
    std::vector<RowPatch> patches = parcel(30.0, 2.5);
    // 3 or 4 of the 8 windows around the middle one agree with it.
    for (int k = 0, left = parallel; k < 9; ++k) {
      if (k == 4 || left-- > 0) continue;
      patches[static_cast<std::size_t>(k)].angle_rad = rad_from_deg(80.0);
    }
    const std::vector<RowPatch> kept = consistent_windows(patches, {});
    const bool is_kept = std::any_of(kept.begin(), kept.end(), [](const RowPatch& patch) {
      return patch.middle == Vector2d(10.0, 10.0);
    });
    EXPECT_EQ(is_kept, parallel == 4);
  }
}

TEST(RowDirection, OtherBlocksAreConnectedGroupsOfClearWindows) {
  const std::vector<RowPatch> main = parcel(30.0, 2.5);
  std::vector<RowPatch> patches = main;
  // A block of three, one of two, a lone window, and two that are not clear.
  for (const double x : {40.0, 50.0}) patches.push_back(window(x, 0.0, 120.0, 2.5, 0.5));
  for (const double x : {100.0, 110.0, 120.0}) patches.push_back(window(x, 0.0, 70.0, 3.5, 0.5));
  patches.push_back(window(200.0, 0.0, 10.0, 2.5, 0.5));
  for (const double x : {300.0, 310.0}) patches.push_back(window(x, 0.0, 10.0, 2.5, 0.2));
  const std::vector<std::vector<RowPatch>> groups = other_patches(patches, main, {});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].size(), 3u);
  EXPECT_EQ(groups[0][0].spacing_m, 3.5);
  EXPECT_EQ(groups[1].size(), 2u);
}

TEST(RowDirection, GroupsOfOtherBlocksDivideByDirectionAndSpacing) {
  const auto groups_of = [](double angle_deg, double spacing_m, double apart_m) {
    return other_patches(
               {window(0, 0, 20.0, 2.5, 0.5), window(apart_m, 0, angle_deg, spacing_m, 0.5)}, {},
               {})
        .size();
  };
  EXPECT_EQ(groups_of(29.0, 2.5, 10.0), 1u);
  EXPECT_EQ(groups_of(31.0, 2.5, 10.0), 0u);
  EXPECT_EQ(groups_of(20.0, 2.95, 10.0), 1u);
  EXPECT_EQ(groups_of(20.0, 3.05, 10.0), 0u);
  EXPECT_EQ(groups_of(20.0, 2.5, 20.0), 0u);
}

}  // namespace
}  // namespace vinerow::mapping::row_direction_test
