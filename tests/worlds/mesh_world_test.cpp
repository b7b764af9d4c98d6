#include "worlds/mesh/mesh_world.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"
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
          "model 'vine_t1' (included 18 times) is missing; a generated trellis row replaces it"),
      std::string::npos)
      << notes;
  EXPECT_EQ(notes.find("sun"), std::string::npos) << "lights are no models to miss";

  ParameterSet vines = parameters.make_group("vines");
  vines.set("pruning", std::string("pergola"));
  parameters.set("vines", std::vector<ParameterSet>{vines}).set("canopy_width_m", 3.5);
  EXPECT_EQ(test::config_error_of([&] { test::make_world("mesh", parameters); }),
            "canopy_width_m = 3.5 m, must be <= the width of alley 0 = 3 m for a pergola");
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

/// A hillside that rises by 0.2 to the east from z = -30 m, as squares of 10 m, 100 m x 100 m.
std::string hillside_obj() {
  std::string text;
  for (int j = 0; j <= 10; ++j) {
    for (int i = 0; i <= 10; ++i) {
      text += fmt::format("v {} {} {}\n", 10 * i, 10 * j, -30.0 + 2.0 * i);
    }
  }
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) {
      const int k = 11 * j + i + 1;
      text += fmt::format("f {} {} {} {}\n", k, k + 1, k + 12, k + 11);
    }
  }
  return text;
}

TEST(MeshWorld, AHillsideIsTheGroundWithoutAWordAndNoPlaneCutsIt) {
  const std::string hill = test::temporary_file("hillside.obj", hillside_obj());
  const std::string cube = test::temporary_file("cube.obj", test::cube_obj());
  const auto world = test::make_world(
      "mesh", with_items({{{"file", cube}, {"x_m", 50.0}, {"z_m", -20.0}}, {{"file", hill}}}));
  EXPECT_FALSE(world->terrain.has_value());
  ASSERT_EQ(world->meshes.size(), 2u);
  EXPECT_EQ(world->meshes[0].surface, SurfaceClass::kObstacle);
  EXPECT_EQ(world->meshes[1].surface, SurfaceClass::kTerrain);
  ASSERT_EQ(world->notes.size(), 1u);
  EXPECT_EQ(world->notes[0],
            "mesh 'hillside' is under the whole world and is used as its ground, without a plane");
  // Said to be an obstacle it is one, and a plane lies under it.
  const auto said = test::make_world(
      "mesh", with_items({{{"file", hill}, {"surface", std::string("obstacle")}}}));
  EXPECT_TRUE(said->terrain.has_value());
  EXPECT_EQ(said->meshes[0].surface, SurfaceClass::kObstacle);
}

TEST(MeshWorld, CanopyMayStateItsLeafArea) {
  const std::string cube = test::temporary_file("cube.obj", test::cube_obj());
  const auto world = test::make_world(
      "mesh",
      with_items(
          {{{"file", cube}, {"surface", std::string("canopy")}, {"leaf_area_density_m2pm3", 4.5}},
           {{"file", cube}, {"x_m", 9.0}}}));
  ASSERT_TRUE(world->meshes[0].foliage);
  EXPECT_EQ(world->meshes[0].foliage->area_density_m2pm3, 4.5);
  EXPECT_FALSE(world->meshes[1].foliage);
  EXPECT_EQ(
      test::config_error_of([&] {
        test::make_world("mesh", with_items({{{"file", cube}, {"leaf_area_density_m2pm3", 4.5}}}));
      }),
      "items[0]: leaf_area_density_m2pm3 is only for surface: canopy");
}

TEST(MeshWorld, AHouseIsNoGround) {
  // 20 m x 10 m x 6 m: more wall than roof is needed for a house, half as much is allowed to
  // ground.
  const std::string house = test::temporary_file(
      "house.obj",
      "v 0 0 0\nv 20 0 0\nv 20 10 0\nv 0 10 0\nv 0 0 6\nv 20 0 6\nv 20 10 6\nv 0 10 6\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const auto world = test::make_world("mesh", with_items({{{"file", house}}}));
  EXPECT_TRUE(world->terrain.has_value());
  EXPECT_EQ(world->meshes[0].surface, SurfaceClass::kObstacle);
}

/// A world file beside `models`, with one model of the mesh URI `uri`.
std::string sdf_world_with(const std::string& name, const std::string& uri,
                           const std::string& mesh_file, const std::string& mesh,
                           const std::string& head = "") {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_worlds_test" / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories((folder / "models/thing" / mesh_file).parent_path());
  std::filesystem::create_directories(folder / "worlds");
  std::ofstream(folder / "models/thing" / mesh_file) << mesh;
  std::ofstream(folder / "models/thing/model.sdf")
      << "<sdf version='1.9'><model name='thing'><link name='l'><visual name='v'><geometry><mesh>"
         "<uri>"
      << uri << "</uri></mesh></geometry></visual></link></model></sdf>";
  std::ofstream(folder / "worlds/w.sdf")
      << "<sdf version='1.9'><world name='w'>" << head << "\n<include><uri>model://sun</uri>"
      << "</include>\n<include><uri>model://thing</uri><pose>5 0 0 0 0 0</pose></include></world>"
         "</sdf>";
  return (folder / "worlds/w.sdf").string();
}

TEST(MeshWorld, LoadsModelsWhoseMeshUrisAreRelative) {
  ParameterSet parameters = test::world_parameters("mesh");
  parameters.set("sdf_file", sdf_world_with("relative", "meshes/visual/x.obj",
                                            "meshes/visual/x.obj", hillside_obj(),
                                            "<spherical_coordinates><latitude_deg>49.9"
                                            "</latitude_deg><longitude_deg>7.25</longitude_deg>"
                                            "<elevation>180</elevation></spherical_coordinates>"));
  const auto world = test::make_world("mesh", parameters);
  ASSERT_EQ(world->meshes.size(), 1u);
  EXPECT_EQ(world->meshes[0].surface, SurfaceClass::kTerrain);
  EXPECT_FALSE(world->terrain.has_value());
  EXPECT_DOUBLE_EQ(world->origin.latitude_rad, rad_from_deg(49.9));
  EXPECT_DOUBLE_EQ(world->origin.longitude_rad, rad_from_deg(7.25));
  EXPECT_EQ(world->origin.altitude_m, 180.0);
  // What the scenario says stands above the file.
  parameters.set("origin_latitude_deg", -33.9).set("origin_longitude_deg", 18.8);
  EXPECT_DOUBLE_EQ(test::make_world("mesh", parameters)->origin.latitude_rad, rad_from_deg(-33.9));
}

TEST(MeshWorld, ACubeOfAKilometreIsDoubtedWithTheRemedyAndAHillsideIsNot) {
  const std::string cube = test::temporary_file("cube.obj", test::cube_obj());
  const auto notes = [&](double scale, const std::string& surface) {
    return test::make_world("mesh",
                            with_items({{{"file", cube}, {"scale", scale}, {"surface", surface}},
                                        {{"file", cube}, {"scale", scale}, {"surface", surface}}}))
        ->notes;
  };
  EXPECT_EQ(notes(100.0, "obstacle"), std::vector<std::string>{});
  EXPECT_EQ(notes(1000.0, "obstacle"),
            std::vector<std::string>{cube + " is read as 1000 x 1000 x 1000 m; if it is in "
                                            "millimetres, set its unit_m: 0.001"});
  EXPECT_EQ(notes(5000.0, "terrain"), std::vector<std::string>{});
  EXPECT_EQ(notes(5001.0, "terrain").size(), 1u);

  ParameterSet parameters = test::world_parameters("mesh");
  const std::string huge =
      "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 0 0 1000\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  parameters.set("sdf_file", sdf_world_with("huge", "x.obj", "x.obj", huge));
  const auto world = test::make_world("mesh", parameters);
  ASSERT_EQ(world->notes.size(), 1u);
  EXPECT_NE(world->notes[0].find("x.obj is read as 1000 x 1000 x 1000 m; if it is in millimetres, "
                                 "write <scale>0.001 0.001 0.001</scale> into its <mesh>"),
            std::string::npos)
      << world->notes[0];
}

TEST(MeshWorld, RefusesAWorldOfWhichNoMeshLoads) {
  const std::string file =
      sdf_world_with("nothing", "meshes/y.obj", "meshes/x.obj", test::cube_obj());
  const auto models = std::filesystem::path(file).parent_path().parent_path() / "models";
  ParameterSet parameters = test::world_parameters("mesh");
  parameters.set("sdf_file", file);
  EXPECT_EQ(test::config_error_of([&] { test::make_world("mesh", parameters); }),
            file + ":3: model 'thing': mesh 'meshes/y.obj' is not at '" +
                (models / "thing/meshes/y.obj").string() +
                "'; the world has no mesh that could be loaded: put the files there or name their "
                "folders with model_folders");
  parameters.set("model_folders", std::vector<std::string>{"/nowhere"});
  EXPECT_EQ(test::config_error_of([&] { test::make_world("mesh", parameters); }),
            file +
                ":3: model 'thing' has no model.sdf in a folder 'thing' of /nowhere; the world "
                "has no mesh that could be loaded: put the files there or name their folders "
                "with model_folders");
}

TEST(MeshWorld, StandInRowsFollowAGroundOfMeshes) {
  ParameterSet parameters = test::world_parameters("mesh");
  const std::string hill = test::temporary_file("hillside.obj", hillside_obj());
  ParameterSet item = parameters.make_group("items");
  item.set("file", hill);
  parameters.set("items", std::vector<ParameterSet>{item});
  parameters.set("sdf_file", test::temporary_file(
                                 "row_on_hill.world",
                                 "<sdf version='1.9'><world name='w'><include><uri>model://vine"
                                 "</uri><pose>50 50 0 0 0 0</pose></include></world></sdf>"));
  const auto world = test::make_world("mesh", parameters);
  ASSERT_EQ(world->rows->rows.size(), 1u);
  // The piece of 6 m begins at x = 47 m, where the hill is at z = -30 + 0.2 * 47.
  EXPECT_NEAR(world->rows->rows[0].line_W.front().z(), -20.6, 1e-5);
  EXPECT_FALSE(world->terrain.has_value());
}

TEST(MeshWorld, ModelsWrittenOutInTheWorldArePlaced) {
  VINEROW_OUTSIDE_DATA(file, "bacchus_lcas/bacchus_gazebo/worlds/riseholme_ncnr.world");
  ParameterSet parameters = test::world_parameters("mesh");
  parameters.set("sdf_file", file.string());
  const auto world = test::make_world("mesh", parameters);
  const auto fences =
      std::count_if(world->meshes.begin(), world->meshes.end(),
                    [](const MeshInstance& mesh) { return mesh.name.rfind("fence_5", 0) == 0; });
  EXPECT_GE(fences, 6);
  EXPECT_TRUE(world->terrain.has_value()) << "fences are no ground";
}

}  // namespace
}  // namespace vinerow::worlds::mesh_world_test
