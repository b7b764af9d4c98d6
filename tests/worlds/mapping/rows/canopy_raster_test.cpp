/// Rasters of a few points whose squares are known.

#include "worlds/mapping/rows/canopy_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/core/error.h"
#include "tests/worlds/mapping/rows/painted_rows.h"

namespace vinerow::mapping::canopy_raster_test {
namespace {

/// Level ground at z = 0 from (0, 0).
HeightField level_field() {
  HeightField field;
  field.columns = field.rows = 2;
  field.cell_m = 100.0;
  field.heights_m.assign(4, 0.0f);
  return field;
}

TEST(CanopyRaster, SquaresCountTheirPointsUpToTheAverage) {
  const HeightField field = level_field();
  ParcelCloud cloud;
  // The box is from (0, 0) to (2, 1).
  cloud.points = {{0.0f, 0.0f, 0.0f}, {2.0f, 1.0f, 0.0f}};
  const auto add = [&](float x, float y, float z, int count) {
    for (int k = 0; k < count; ++k) cloud.points.emplace_back(x, y, z);
  };
  add(0.25f, 0.15f, 1.0f, 1);
  add(1.25f, 0.75f, 1.5f, 7);
  add(0.55f, 0.55f, 0.7f, 5);  // not above 0.7 m
  add(0.65f, 0.55f, 6.0f, 5);  // not below 6 m
  const CanopyRaster raster =
      make_canopy_raster(cloud, HeightAbove(field, Eigen::Vector3d::Zero()), 0.1, 0.7, 6.0);
  EXPECT_EQ(raster.columns, 21);
  EXPECT_EQ(raster.rows, 11);
  float sum = 0.0f;
  for (const float weight : raster.weights) sum += weight;
  // The average of 1 and 7 is 4.
  EXPECT_EQ(raster.weights[static_cast<std::size_t>(raster.cell_of(0.25, 0.15))], 0.25f);
  EXPECT_EQ(raster.weights[static_cast<std::size_t>(raster.cell_of(1.25, 0.75))], 1.0f);
  EXPECT_EQ(sum, 1.25f);
}

TEST(CanopyRaster, CellOfIsTheSquareWhoseMiddleIsThere) {
  const CanopyRaster raster = test::empty_raster(3.0, 2.0);
  for (int j = 0; j < raster.rows; ++j) {
    for (int i = 0; i < raster.columns; ++i) {
      const Eigen::Vector2d p = raster.middle_of(i, j);
      EXPECT_EQ(raster.cell_of(p.x(), p.y()), j * raster.columns + i);
    }
  }
  EXPECT_EQ(raster.cell_of(-0.01, 1.0), -1);
  EXPECT_EQ(raster.cell_of(3.01, 1.0), -1);
  EXPECT_EQ(raster.cell_of(1.0, 2.01), -1);
  EXPECT_EQ(raster.cell_of(std::nan(""), 1.0), -1);
}

TEST(CanopyRaster, CloudsTooLargeForOneRasterAreRefused) {
  const HeightField field = level_field();
  ParcelCloud cloud;
  cloud.points = {{0.0f, 0.0f, 1.0f}, {3000.0f, 3000.0f, 1.0f}};
  const HeightAbove above(field, Eigen::Vector3d::Zero());
  EXPECT_THROW(make_canopy_raster(cloud, above, 0.1, 0.5, 6.0), ConfigError);
}

TEST(CanopyRaster, BodyHeightIsThreeFifthsOfTheMedian) {
  const HeightField field = level_field();
  const HeightAbove above(field, Eigen::Vector3d::Zero());
  const auto body_of = [&](float highest_m) {
    // Even heights from 0 to highest_m: the median above the cut of 0.5 m is in their middle.
    ParcelCloud cloud;
    for (int k = 0; k < 2000; ++k) {
      cloud.points.emplace_back(1.0f, 1.0f, highest_m * static_cast<float>(k) / 2000.0f);
    }
    return body_height_m(cloud, above, 0.5, 6.0);
  };
  EXPECT_NEAR(body_of(2.0f), 0.6 * 1.25, 0.002);
  EXPECT_EQ(body_of(5.0f), 1.1);
  EXPECT_EQ(body_of(0.9f), 0.5);
  EXPECT_EQ(body_of(0.4f), 0.5);
}

TEST(CanopyRaster, CoarseSquaresHaveTheMeanOfTheirs) {
  CanopyRaster raster = test::empty_raster(0.5, 0.3);
  for (std::size_t k = 0; k < raster.weights.size(); ++k) {
    raster.weights[k] = static_cast<float>(k);
  }
  const CanopyRaster coarse = coarsen(raster, 2);
  EXPECT_EQ(coarse.columns, 3);
  EXPECT_EQ(coarse.rows, 2);
  EXPECT_DOUBLE_EQ(coarse.cell_m, 0.2);
  EXPECT_EQ(coarse.weights[0], (0.0f + 1.0f + 5.0f + 6.0f) / 4.0f);
  EXPECT_EQ(coarse.weights[4], (12.0f + 13.0f) / 4.0f);  // beyond the edge there is no canopy
}

}  // namespace
}  // namespace vinerow::mapping::canopy_raster_test
