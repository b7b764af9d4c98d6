#include "worlds/orchard/orchard.h"
#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/worlds/world_fixture.h"

namespace vinerow::worlds::orchard_test {
namespace {

TEST(Orchard, PapersMapHasItsRowsAndFreeRows) {
  // Paper, section 2.2: n = 9, N = 10, P = 10 m, w = 2 m, l = 80 m, Ys = 10 m.
  const auto world = test::make_world("orchard", test::world_parameters("orchard"));
  ASSERT_EQ(world->rows->rows.size(), 9u);
  ASSERT_EQ(world->rows->alleys.size(), 10u);
  for (int k = 0; k < 9; ++k) {
    const auto& line = world->rows->rows[static_cast<std::size_t>(k)].line_W;
    EXPECT_EQ(line.front(), Eigen::Vector3d(10.0 * (k + 1), 10, 0));
    EXPECT_EQ(line.back(), Eigen::Vector3d(10.0 * (k + 1), 90, 0));
  }
  for (int k = 0; k < 10; ++k) {
    const Alley& alley = world->rows->alleys[static_cast<std::size_t>(k)];
    ASSERT_EQ(alley.line_W.size(), 2u);
    EXPECT_EQ(alley.line_W.front(), Eigen::Vector3d(5.0 + 10.0 * k, 10, 0));
    EXPECT_EQ(alley.line_W.back(), Eigen::Vector3d(5.0 + 10.0 * k, 90, 0));
    EXPECT_EQ(alley.width_m, 10.0);
  }
  EXPECT_EQ(world->spawn_points.front().name, "alley_0_start");
  EXPECT_EQ(world->spawn_points.front().p_W, Eigen::Vector2d(5, 10));
  EXPECT_DOUBLE_EQ(world->spawn_points.front().yaw_rad, 1.5707963267948966);
}

TEST(Orchard, MapMatrixHoldsTheOccupiedArea) {
  OrchardLayout layout;
  layout.refinement_per_m2 = 4.0;
  const OccupancyGrid grid = make_occupancy(layout);
  EXPECT_EQ(grid.columns, 200);
  EXPECT_EQ(grid.rows, 200);
  // n w l = 1440 m2 at 4 elements per square metre.
  EXPECT_EQ(std::accumulate(grid.cells.begin(), grid.cells.end(), 0), 5760);
  EXPECT_TRUE(grid.occupied(20, 20));   // centre (10.25, 10.25)
  EXPECT_FALSE(grid.occupied(10, 20));  // centre (5.25, 10.25)
  EXPECT_FALSE(grid.occupied(20, 19));  // before Ys
}

TEST(Orchard, CrownsStayInsideTheRowsWidth) {
  const auto world = test::make_world("orchard", test::world_parameters("orchard"));
  for (const MeshInstance& instance : world->meshes) {
    if (instance.surface != SurfaceClass::kCanopy || !instance.collides) continue;
    const double row_x = std::round(instance.X_WM.p.x() / 10.0) * 10.0;
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      const double x = (instance.X_WM * v.cast<double>()).x();
      ASSERT_LE(std::abs(x - row_x), 1.0 + 1e-5) << instance.name;
    }
  }
}

TEST(Orchard, TheCrownOfASingleTreeEndsWithItsRow) {
  ParameterSet parameters = test::world_parameters("orchard");
  parameters.set("row_length_m", 4.0).set("row_start_y_m", 10.0).set("tree_spacing_m", 20.0);
  const auto world = test::make_world("orchard", parameters);
  int crowns = 0;
  for (const MeshInstance& instance : world->meshes) {
    if (!instance.name.starts_with("crown_hull")) continue;
    ++crowns;
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      const double y = (instance.X_WM * v.cast<double>()).y();
      ASSERT_LE(std::abs(y - 12.0), 2.0) << instance.name;
    }
  }
  EXPECT_EQ(crowns, 9);
}

TEST(Orchard, ATreeHasOneTrunkAndItsTwigsAreWood) {
  ParameterSet parameters = test::world_parameters("orchard");
  parameters.set("leaves", std::vector<ParameterSet>{parameters.make_group("leaves")});
  const auto world = test::make_world("orchard", parameters);
  int trees = 0, trunks = 0, twigs = 0;
  for (const MeshInstance& instance : world->meshes) {
    trees += instance.name.starts_with("crown_hull") ? 1 : 0;
    // What pictures call a trunk (tools/dataset/thing_shapes.cpp).
    trunks += instance.surface == SurfaceClass::kTrunk && !instance.label ? 1 : 0;
    if (!instance.name.starts_with("twigs")) continue;
    EXPECT_EQ(instance.label, Label::kWood);
    ++twigs;
  }
  EXPECT_GT(trees, 0);
  EXPECT_EQ(trunks, trees);
  EXPECT_EQ(twigs, trees);
}

TEST(Orchard, BoundsTheMatrixOfTheMapOnlyWhereItIsWanted) {
  ParameterSet parameters = test::world_parameters("orchard");
  for (const char* name : {"field_width_m", "field_length_m"}) parameters.set(name, 6000.0);
  parameters.set("terrain_cell_m", 100.0).set("occupancy_cell_m", 0.0);
  EXPECT_EQ(test::config_error_of([&] { test::make_world("orchard", parameters); }), "no error");
  parameters.set("refinement_per_m2", 4.0);
  EXPECT_EQ(test::config_error_of([&] { test::make_world("orchard", parameters); }),
            "refinement_per_m2 = 4 1/m2 gives 144 million elements, must be at most 100 million");
}

TEST(Orchard, RefusesRowsThatDoNotFit) {
  const auto error = [](const char* name, double value) {
    return test::config_error_of([&] {
      ParameterSet parameters = test::world_parameters("orchard");
      parameters.set(name, value);
      test::make_world("orchard", parameters);
    });
  };
  EXPECT_EQ(error("row_length_m", 95.0),
            "row_start_y_m + row_length_m = 105 m, must be <= field_length_m = 100 m");
  EXPECT_EQ(
      error("row_width_m", 12.0),
      "row_width_m = 12 m, must be < field_width_m / (plant_rows + 1) = 10 m, or no alley is free");
  EXPECT_EQ(error("tree_spacing_m", 1e-6),
            "tree_spacing_m = 1e-06 m, must be >= 0.1 m and <= 100 m");
  EXPECT_EQ(error("plant_rows", -3.0), "plant_rows = -3, must be >= 1 and <= 1000");
  EXPECT_EQ(error("crown_base_m", 5.0), "crown_base_m = 5 m, must be < tree_height_m = 3.6 m");
}

}  // namespace
}  // namespace vinerow::worlds::orchard_test
