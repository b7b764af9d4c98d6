/// The ground that planners receive if a map has its own terrain.

#include "engine/sim/map_ground.h"
#include "engine/api/height_field.h"

#include <gtest/gtest.h>

namespace vinerow::map_ground_test {
namespace {

/// z = 0.5 x + 0.25 y + 3 over 20 m x 10 m from (-5, 2).
HeightField slope() {
  HeightField field;
  field.columns = 11;
  field.rows = 6;
  field.cell_m = 2.0;
  field.corner_W = {-5.0, 2.0};
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      field.heights_m.push_back(
          static_cast<float>(0.5 * (-5.0 + 2.0 * i) + 0.25 * (2.0 + 2.0 * j) + 3.0));
    }
  }
  return field;
}

TEST(MapGround, IsTheMapsTerrain) {
  const HeightField field = slope();
  const MapGround ground(field);
  EXPECT_NEAR(ground.ground_height_m(1.3, 7.7, 1e4).value(), 0.5 * 1.3 + 0.25 * 7.7 + 3.0, 1e-6);
  EXPECT_FALSE(ground.ground_height_m(1.3, 7.7, 5.0)) << "from below there is none";
}

TEST(MapGround, GoesOnForTenMetresBeyondItsEdge) {
  const HeightField field = slope();
  const MapGround ground(field);
  // The edge at x = 15 m.
  EXPECT_NEAR(ground.ground_height_m(24.9, 7.7, 1e4).value(), 0.5 * 15.0 + 0.25 * 7.7 + 3.0, 1e-6);
  EXPECT_FALSE(ground.ground_height_m(25.1, 7.7, 1e4));
  EXPECT_TRUE(ground.ground_height_m(0.0, -7.9, 1e4));
  EXPECT_FALSE(ground.ground_height_m(0.0, -8.1, 1e4));
  EXPECT_FALSE(ground.ground_height_m(-15.1, 5.0, 1e4));
  EXPECT_FALSE(ground.ground_height_m(0.0, 22.1, 1e4));
}

TEST(MapGround, HasNothingElse) {
  const HeightField field = slope();
  const MapGround ground(field);
  EXPECT_FALSE(ground.cast_ray({0, 5, 50}, -Eigen::Vector3d::UnitZ(), 100.0, kAllSurfaces));
  EXPECT_EQ(ground.distance_to_box_m({}, {1, 1, 1}, 7.0, kPlantMask), 7.0);
}

}  // namespace
}  // namespace vinerow::map_ground_test
