#include "controllers/estimation/row_localisation/row_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "tests/controllers/support/row_mesh_map.h"

namespace vinerow::test::row_ground_test {
namespace {

TEST(RowGround, IsThePlaneOfASlope) {
  const RowMeshBlock block{.rows = 4, .length_m = 40.0};
  const RowMap map = make_row_mesh_map(block, RandomStream(1, "", "map"));
  const controllers::RowGround rows(map);
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
  const controllers::RowGround rows(map);
  const auto away_m = [&](double along_m, double across_m) {
    return rows.at(row_mesh_ground(block, along_m, across_m))->away_m;
  };
  EXPECT_NEAR(away_m(20.0, 1.0), 0.0, 1e-9);
  EXPECT_NEAR(away_m(46.0, 1.0), 6.0, 1e-9);   // beyond the rows' ends
  EXPECT_NEAR(away_m(20.0, -3.0), 3.0, 1e-9);  // beside the first row
  EXPECT_NEAR(away_m(-4.0, 8.0), 5.0, 1e-9);   // 4 m and 3 m off a corner
}

/// A hill between the ends of straight lines: z = x (40 - x) / 100 + y / 10, four metres above the
/// lines in their middle.
RowMap make_hill_map() {
  RowMap map;
  for (const double y : {0.0, 2.5}) {
    PlantRow row;
    row.id = static_cast<int>(map.rows.size());
    row.line_W = {{0.0, y, 0.1 * y}, {40.0, y, 0.1 * y}};
    map.rows.push_back(row);
  }
  HeightField terrain;
  terrain.columns = 101, terrain.rows = 41;
  terrain.cell_m = 0.5;
  terrain.corner_W = {-5.0, -5.0};
  for (int j = 0; j < terrain.rows; ++j) {
    for (int i = 0; i < terrain.columns; ++i) {
      const double x = terrain.corner_W.x() + 0.5 * i, y = terrain.corner_W.y() + 0.5 * j;
      terrain.heights_m.push_back(static_cast<float>(x * (40.0 - x) / 100.0 + y / 10.0));
    }
  }
  map.terrain = terrain;
  return map;
}

TEST(RowGround, IsTheMapsTerrainWhereItHasOne) {
  const controllers::RowGround rows(make_hill_map());
  for (const double x : {-3.2, 8.3, 20.0, 31.7, 44.0}) {
    for (const double y : {-3.0, 1.25, 9.0}) {
      const auto ground = rows.at({x, y, 10.0});
      ASSERT_TRUE(ground);
      const Eigen::Vector3d on_W(x, y, x * (40.0 - x) / 100.0 + y / 10.0);
      // Chords of 0.5 m cut 0.25^2 / 100 m off the parabola.
      EXPECT_NEAR(ground->normal_W.dot(on_W), ground->offset_m, 1e-3);
      const Eigen::Vector3d steep(-(40.0 - 2.0 * x) / 100.0, -0.1, 1.0);
      EXPECT_LT((ground->normal_W - steep.normalized()).norm(), 1e-3);
      EXPECT_EQ(ground->away_m, 0.0) << "the terrain is known there, whatever the rows say";
    }
  }
  // At its very edge, and beyond it, where the lines go on.
  const auto edge = rows.at({-5.0, -5.0, 0.0});
  ASSERT_TRUE(edge);
  EXPECT_NEAR(edge->normal_W.dot(Eigen::Vector3d(-5.0, -5.0, -2.75)), edge->offset_m, 1e-6);
  const auto beyond = rows.at({50.0, 1.25, 0.0});
  ASSERT_TRUE(beyond);
  EXPECT_NEAR(beyond->normal_W.dot(Eigen::Vector3d(50.0, 1.25, 0.125)), beyond->offset_m, 1e-9);
  EXPECT_NEAR(beyond->away_m, 10.0, 1e-9);
}

TEST(RowGround, OneRowTellsNoPlane) {
  const RowMap map = make_row_mesh_map({.rows = 1, .length_m = 40.0}, RandomStream(1, "", "map"));
  EXPECT_FALSE(controllers::RowGround(map).at({0, 0, 1}));
  EXPECT_FALSE(controllers::RowGround(RowMap{}).at({0, 0, 1}));
}

TEST(RowGround, TheNearestGroundInAConeIsAtItsLowerEdge) {
  // A slope of 10 deg that rises along x through the origin, and a cone of 15 deg looking along x
  // from a height h above it: h cos(10) is at a right angle, 65 deg from the cone's lower edge.
  const double slope = rad_from_deg(10.0), h = 0.2;
  controllers::GroundPlane ground;
  ground.normal_W = {-std::sin(slope), 0.0, std::cos(slope)};
  const Eigen::Vector3d sensor_W(3.0, 1.0, 3.0 * std::tan(slope) + h);
  const auto nearest_m = [&](const Eigen::Vector3d& dir_W, double half_angle_deg) {
    return controllers::nearest_in_cone_m(ground, sensor_W, dir_W, rad_from_deg(half_angle_deg));
  };
  EXPECT_NEAR(*nearest_m({1, 0, 0}, 15.0), h * std::cos(slope) / std::cos(rad_from_deg(65.0)),
              1e-12);
  EXPECT_NEAR(*nearest_m({0, 0, -1}, 15.0), h * std::cos(slope), 1e-12);
  EXPECT_FALSE(nearest_m({-1, 0, 0}, 5.0)) << "downhill the ground falls away faster";
  EXPECT_EQ(*controllers::nearest_in_cone_m(ground, {3, 1, 0}, {1, 0, 0}, 0.0), 0.0)
      << "below the ground";
}

TEST(RowGround, AConeSeesItsNearestPointOfTheGround) {
  const controllers::GroundPlane level;
  const auto down = [](double tilt_rad) {
    return Eigen::Vector3d(std::sin(tilt_rad), 0.0, -std::cos(tilt_rad));
  };
  // A ray: height = range cos(tilt).
  EXPECT_NEAR(*controllers::plane_distance_m(level, down(0.3), 0.0, 2.0), 2.0 * std::cos(0.3),
              1e-12);
  // Within the cone the nearest point counts, beyond it the cone's edge.
  EXPECT_NEAR(*controllers::plane_distance_m(level, down(0.2), 0.26, 2.0), 2.0, 1e-12);
  EXPECT_NEAR(*controllers::plane_distance_m(level, down(0.5), 0.26, 2.0), 2.0 * std::cos(0.24),
              1e-12);
  EXPECT_FALSE(controllers::plane_distance_m(level, down(1.7), 0.1, 2.0));
}

}  // namespace
}  // namespace vinerow::test::row_ground_test
