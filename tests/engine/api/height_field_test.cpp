#include <gtest/gtest.h>

#include "engine/api/world_model.h"

namespace vinerow::height_field_test {
namespace {

HeightField tilted_cell() {
  HeightField field;
  field.columns = 2;
  field.rows = 2;
  field.cell_m = 2.0;
  field.corner_W = {10.0, 20.0};
  field.heights_m = {0.0f, 1.0f, 2.0f, 4.0f};  // (10,20) (12,20) (10,22) (12,22)
  return field;
}

TEST(HeightField, SamplesAreMetExactly) {
  const HeightField field = tilted_cell();
  EXPECT_EQ(field.height_m(10, 20), 0.0);
  EXPECT_EQ(field.height_m(12, 20), 1.0);
  EXPECT_EQ(field.height_m(10, 22), 2.0);
  EXPECT_EQ(field.height_m(12, 22), 4.0);
}

TEST(HeightField, EachTriangleIsFlat) {
  const HeightField field = tilted_cell();
  // By hand, lower right triangle: h = u * 1 + v * 3; upper left: h = v * 2 + u * 2, with u, v in
  // cells.
  EXPECT_DOUBLE_EQ(field.height_m(11.5, 20.5), 0.75 * 1 + 0.25 * 3);
  EXPECT_DOUBLE_EQ(field.height_m(10.5, 21.5), 0.75 * 2 + 0.25 * 2);
  EXPECT_DOUBLE_EQ(field.height_m(11.0, 21.0), 2.0);
  const Eigen::Vector3d lower = field.normal_W(11.5, 20.5);
  EXPECT_NEAR((lower - Eigen::Vector3d(-0.5, -1.5, 1.0).normalized()).norm(), 0.0, 1e-15);
}

TEST(HeightField, TheEdgeContinuesOutside) {
  const HeightField field = tilted_cell();
  EXPECT_EQ(field.height_m(0, 0), 0.0);
  EXPECT_EQ(field.height_m(100, 100), 4.0);
  EXPECT_EQ(field.normal_W(0, 0), Eigen::Vector3d::UnitZ());
}

}  // namespace
}  // namespace vinerow::height_field_test
