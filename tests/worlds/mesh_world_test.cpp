#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "worlds/mesh/mesh.h"

#include <gtest/gtest.h>

#include "tests/support/data.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/mesh/sdf_rows.h"

namespace vinerow::worlds::mesh_world_test {
namespace {

ParameterSet with_items(const std::vector<std::map<std::string, ParameterSet::Value>>& items) {
  ParameterSet parameters = test::world_parameters("mesh");
  std::vector<ParameterSet> list;
  for (const auto& values : items) {
    ParameterSet item = parameters.make_group("items");
    for (const auto& [name, value] : values) item.set(name, value);
    list.push_back(item);
  }
  parameters.set("items", list);
  return parameters;
}

TEST(MeshWorld, PlacesFilesByPose) {
  const std::string cube = test::temporary_file("cube.obj", test::cube_obj());
  const auto world =
      test::make_world("mesh", with_items({{{"file", cube}, {"surface", std::string("terrain")}},
                                           {{"file", cube},
                                            {"name", std::string("far")},
                                            {"x_m", 10.0},
                                            {"z_m", 2.0},
                                            {"yaw_deg", 90.0},
                                            {"scale", 2.0},
                                            {"unit_m", 0.1}}}));
  ASSERT_EQ(world->meshes.size(), 2u);
  EXPECT_FALSE(world->terrain.has_value()) << "the first cube is the ground";
  const MeshInstance& far = world->meshes[1];
  EXPECT_EQ(far.name, "far");
  EXPECT_EQ(far.surface, SurfaceClass::kObstacle);
  // Corner (1, 0, 0) in units of 0.1 m, twice as large, turned to +y.
  Eigen::AlignedBox3d box;
  for (const auto& v : far.mesh->vertices) box.extend(far.X_WM * v.cast<double>());
  EXPECT_LT((box.min() - Eigen::Vector3d(9.8, 0, 2)).norm(), 1e-6);
  EXPECT_LT((box.max() - Eigen::Vector3d(10, 0.2, 2.2)).norm(), 1e-6);
}

TEST(MeshWorld, FlatGroundLiesUnderObjectsWithoutTerrain) {
  const std::string cube = test::temporary_file("cube.obj", test::cube_obj());
  const auto world = test::make_world("mesh", with_items({{{"file", cube}, {"x_m", 100.0}}}));
  ASSERT_TRUE(world->terrain.has_value());
  EXPECT_TRUE(world->terrain->contains(95, -5));
  EXPECT_EQ(world->terrain->height_m(100, 0), 0.0);
}

TEST(MeshWorld, RefusesBadInputInOneSentence) {
  EXPECT_EQ(test::config_error_of([] { test::make_world("mesh", test::world_parameters("mesh")); }),
            "mesh: nothing to load, give items (mesh files) or sdf_file");
  EXPECT_EQ(test::config_error_of([] {
              test::make_world("mesh", with_items({{{"file", std::string("/none.dae")}}}));
            }),
            "mesh file '/none.dae' does not exist");
  EXPECT_NE(test::config_error_of([] {
              with_items({{{"x_m", 1.0}}});
            }).find("file must be given"),
            std::string::npos);
}

TEST(MeshWorld, OrchardGroundAndItsMissingFiles) {
  VINEROW_OUTSIDE_DATA(meshes, "cpr_gazebo/cpr_orchard_gazebo/meshes");
  const auto world =
      test::make_world("mesh", with_items({{{"file", (meshes / "orchard_world.dae").string()},
                                            {"surface", std::string("terrain")}}}));
  ASSERT_EQ(world->notes.size(), 1u);
  EXPECT_NE(world->notes[0].find("texture 'Ground.png'"), std::string::npos);
  const std::string error = test::config_error_of([&] {
    test::make_world("mesh", with_items({{{"file", (meshes / "orchard_trunks.dae").string()}}}));
  });
  EXPECT_NE(error.find("orchard_trunks.dae' does not exist"), std::string::npos) << error;
}

TEST(MeshWorld, SdfRowsStandWhereTheFileSays) {
  VINEROW_OUTSIDE_DATA(file, "bacchus_lcas/bacchus_gazebo/worlds/vineyard_stage1.world");
  ParameterSet parameters = test::world_parameters("mesh");
  parameters.set("sdf_file", file.string());
  const auto world = test::make_world("mesh", parameters);
  // data/README.md: rows 3 m apart from y = -7.5, pieces 6 m apart at x = -6, 0, 6.
  ASSERT_EQ(world->rows->rows.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& line = world->rows->rows[i].line_W;
    EXPECT_NEAR(line.front().y(), -7.5 + 3.0 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(line.front().x(), -9.0, 1e-9);
    EXPECT_NEAR(line.back().x(), 9.0, 1e-9);
  }
  std::string notes;
  for (const std::string& note : world->notes) notes += note + "\n";
  EXPECT_NE(
      notes.find(
          "model 'vine_t1' (included 18 times) is missing; a trellis row of our own stands in"),
      std::string::npos)
      << notes;
  EXPECT_EQ(notes.find("sun"), std::string::npos) << "lights are no models to miss";
}

TEST(MeshWorld, GroundFollowsTheFeetOfSdfPieces) {
  VINEROW_OUTSIDE_DATA(file, "bacchus_lcas/bacchus_gazebo/worlds/riseholme.world");
  ParameterSet parameters = test::world_parameters("mesh");
  parameters.set("sdf_file", file.string());
  const auto world = test::make_world("mesh", parameters);
  // The file raises pieces by 0.25 m per row of 3 m (and rolls them by 0.085 rad).
  EXPECT_NEAR(world->terrain->height_m(0, -7.5), -0.60, 0.01);
  EXPECT_NEAR(world->terrain->height_m(0, -1.5), -0.10, 0.01);
}

TEST(MeshWorld, FenceModelIsPlacedFromItsOwnFolder) {
  VINEROW_OUTSIDE_DATA(folder, "bacchus_lcas/bacchus_gazebo");
  const std::string world_file =
      test::temporary_file("fence.world",
                           "<sdf version='1.6'><world "
                           "name='w'><include><uri>model://fence_5</uri><pose>5 0 0 0 0 0</pose>"
                           "</include></world></sdf>");
  ParameterSet parameters = test::world_parameters("mesh");
  parameters.set("sdf_file", world_file);
  parameters.set("model_folders", std::vector<std::string>{(folder / "models").string()});
  const auto world = test::make_world("mesh", parameters);
  ASSERT_FALSE(world->meshes.empty());
  EXPECT_EQ(world->meshes[0].X_WM.p, Eigen::Vector3d(5, 0, 0));
}

}  // namespace
}  // namespace vinerow::worlds::mesh_world_test
