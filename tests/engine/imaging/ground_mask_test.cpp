#include "engine/imaging/ground_mask.h"
#include "engine/api/map.h"

#include <gtest/gtest.h>

namespace vinerow::imaging::ground_mask_test {
namespace {

TEST(GroundMask, HoldsDistancesToRowsAndAlleys) {
  RowMap map;
  PlantRow row;
  row.line_W = {{0, 0, 0}, {30, 0, 0}};
  map.rows.push_back(row);
  Alley alley;
  alley.line_W = {{0, 1.25, 0}, {30, 1.25, 0}};
  map.alleys.push_back(alley);
  const GroundMask mask = make_ground_mask(map);
  // Cells of about 12 cm and steps of 1 cm.
  EXPECT_NEAR(mask.row_distance_m(15.0, 0.0), 0.0, 0.08);
  EXPECT_NEAR(mask.row_distance_m(15.0, 0.8), 0.8, 0.08);
  EXPECT_NEAR(mask.alley_distance_m(15.0, 0.65), 0.6, 0.08);
  EXPECT_NEAR(mask.row_distance_m(31.5, 0.0), 1.5, 0.14);  // beyond the end
  EXPECT_DOUBLE_EQ(mask.row_distance_m(500.0, 0.0), GroundMask::kReach_m);
}

TEST(GroundMask, WithoutRowsEverythingIsFar) {
  const GroundMask mask = make_ground_mask({});
  EXPECT_EQ(mask.pixels.width, 1);
  EXPECT_DOUBLE_EQ(mask.row_distance_m(0.5, 0.5), GroundMask::kReach_m);
}

}  // namespace
}  // namespace vinerow::imaging::ground_mask_test
