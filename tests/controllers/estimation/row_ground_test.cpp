#include "controllers/estimation/row_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "tests/controllers/support/row_mesh_map.h"

namespace vinerow::test {
namespace {

TEST(RowGround, IsThePlaneOfASlope) {
  const RowMeshBlock block{.rows = 4, .length_m = 40.0};
  const RowMap map = make_row_mesh_map(block, RandomStream(1, "", "map"));
  const RowGround rows(map);
  for (const double along_m : {2.0, 17.3, 38.0}) {
    for (const double across_m : {0.3, 1.25, 4.0, 7.2}) {
      const Eigen::Vector3d ground_W = row_mesh_ground(block, along_m, across_m);
      const auto ground = rows.at(ground_W + Eigen::Vector3d(0, 0, 1.5));
      ASSERT_TRUE(ground);
      EXPECT_NEAR(ground->normal_W.dot(ground_W), ground->offset_m, 1e-9);
      // Closed form of a plane that rises by g along and by h across: n ~ (-g, -h, 1).
      const double g = block.grade_along, h = block.grade_across;
      EXPECT_NEAR(ground->normal_W.z(), 1.0 / std::sqrt(1.0 + g * g + h * h), 1e-9);
    }
  }
}

TEST(RowGround, TellsHowFarOffTheRowsItIs) {
  const RowMeshBlock block{.rows = 3, .length_m = 40.0};
  const RowMap map = make_row_mesh_map(block, RandomStream(1, "", "map"));
  const RowGround rows(map);
  const auto away_m = [&](double along_m, double across_m) {
    return rows.at(row_mesh_ground(block, along_m, across_m))->away_m;
  };
  EXPECT_NEAR(away_m(20.0, 1.0), 0.0, 1e-9);
  EXPECT_NEAR(away_m(46.0, 1.0), 6.0, 1e-9);   // beyond the rows' ends
  EXPECT_NEAR(away_m(20.0, -3.0), 3.0, 1e-9);  // beside the first row
  EXPECT_NEAR(away_m(-4.0, 8.0), 5.0, 1e-9);   // 4 m and 3 m off a corner
}

TEST(RowGround, OneRowTellsNoPlane) {
  const RowMap map = make_row_mesh_map({.rows = 1, .length_m = 40.0}, RandomStream(1, "", "map"));
  EXPECT_FALSE(RowGround(map).at({0, 0, 1}));
  EXPECT_FALSE(RowGround(RowMap{}).at({0, 0, 1}));
}

TEST(RowGround, TheNearestGroundInAConeIsAtItsLowerEdge) {
  // A slope of 10 deg that rises along x through the origin, and a cone of 15 deg looking along x
  // from a height h above it: h cos(10) is at a right angle, 65 deg from the cone's lower edge.
  const double slope = rad_from_deg(10.0), h = 0.2;
  GroundPlane ground;
  ground.normal_W = {-std::sin(slope), 0.0, std::cos(slope)};
  const Eigen::Vector3d sensor_W(3.0, 1.0, 3.0 * std::tan(slope) + h);
  const auto nearest_m = [&](const Eigen::Vector3d& dir_W, double half_angle_deg) {
    return nearest_in_cone_m(ground, sensor_W, dir_W, rad_from_deg(half_angle_deg));
  };
  EXPECT_NEAR(*nearest_m({1, 0, 0}, 15.0), h * std::cos(slope) / std::cos(rad_from_deg(65.0)),
              1e-12);
  EXPECT_NEAR(*nearest_m({0, 0, -1}, 15.0), h * std::cos(slope), 1e-12);
  EXPECT_FALSE(nearest_m({-1, 0, 0}, 5.0)) << "downhill the ground falls away faster";
  EXPECT_EQ(*nearest_in_cone_m(ground, {3, 1, 0}, {1, 0, 0}, 0.0), 0.0) << "below the ground";
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
