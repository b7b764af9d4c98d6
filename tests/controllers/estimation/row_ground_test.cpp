#include "controllers/estimation/row_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/controllers/support/row_mesh_map.h"

namespace vinerow::test {
namespace {

TEST(RowGround, IsThePlaneOfASlope) {
  const RowMeshBlock block{.rows = 4, .length_m = 40.0};
  const RowMap map = make_row_mesh_map(block, RandomStream(1, "", "map"));
  for (const double along_m : {2.0, 17.3, 38.0}) {
    for (const double across_m : {0.3, 1.25, 4.0, 7.2}) {
      const Eigen::Vector3d ground_W = row_mesh_ground(block, along_m, across_m);
      const auto ground = find_ground(map, ground_W + Eigen::Vector3d(0, 0, 1.5));
      ASSERT_TRUE(ground);
      EXPECT_NEAR(ground->normal_W.dot(ground_W), ground->offset_m, 1e-9);
      // Closed form of a plane that rises by g along and by h across: n ~ (-g, -h, 1).
      const double g = block.grade_along, h = block.grade_across;
      EXPECT_NEAR(ground->normal_W.z(), 1.0 / std::sqrt(1.0 + g * g + h * h), 1e-9);
    }
  }
}

TEST(RowGround, OneRowTellsNoPlane) {
  const RowMap map = make_row_mesh_map({.rows = 1, .length_m = 40.0}, RandomStream(1, "", "map"));
  EXPECT_FALSE(find_ground(map, {0, 0, 1}));
  EXPECT_FALSE(find_ground(RowMap{}, {0, 0, 1}));
}

TEST(RowGround, AConeSeesItsNearestPointOfTheGround) {
  const GroundPlane level;
  const auto down = [](double tilt_rad) {
    return Eigen::Vector3d(std::sin(tilt_rad), 0.0, -std::cos(tilt_rad));
  };
  // A ray: height = range cos(tilt).
  EXPECT_NEAR(*plane_distance_m(level, down(0.3), 0.0, 2.0), 2.0 * std::cos(0.3), 1e-12);
  // Within the cone the nearest point counts, beyond it the cone's edge.
  EXPECT_NEAR(*plane_distance_m(level, down(0.2), 0.26, 2.0), 2.0, 1e-12);
  EXPECT_NEAR(*plane_distance_m(level, down(0.5), 0.26, 2.0), 2.0 * std::cos(0.24), 1e-12);
  EXPECT_FALSE(plane_distance_m(level, down(1.7), 0.1, 2.0));
}

}  // namespace
}  // namespace vinerow::test
