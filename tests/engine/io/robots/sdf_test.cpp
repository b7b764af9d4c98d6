#include "engine/io/robots/sdf.h"

#include <gtest/gtest.h>

#include <fstream>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"

namespace vinerow::io::sdf_test {
namespace {

std::filesystem::path write(const std::string& content) {
  const auto file = std::filesystem::temp_directory_path() /
                    (std::string("vinerow_sdf_") +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".world");
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

std::string error_of(const std::filesystem::path& file) {
  try {
    read_sdf_world(file, {});
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Sdf, ReadsPosesOfIncludes) {
  const SdfWorld world = read_sdf_world(
      write(
          "<sdf version='1.6'><world name='w'>\n<include><uri>model://vine</uri>\n<pose>1 2 3 0 0 "
          "1.5707963267948966</pose><name>a</name></include>\n<include><uri>model://vine</uri></"
          "include>"
          "</world></sdf>"),
      {});
  const std::vector<SdfInclude>& includes = world.includes;
  ASSERT_EQ(includes.size(), 2u);
  EXPECT_EQ(includes[0].model, "vine");
  EXPECT_EQ(includes[0].name, "a");
  EXPECT_TRUE(includes[0].X_WM.p.isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_NEAR(yaw_from_quaternion(includes[0].X_WM.q), kPi / 2, 1e-12);
  EXPECT_EQ(includes[1].name, "vine_1");
  EXPECT_TRUE(includes[1].X_WM.p.isZero());
}

TEST(Sdf, RefusesBadInputWithFileAndLine) {
  EXPECT_EQ(error_of("/none.world"), "SDF file '/none.world' does not exist");
  const auto broken = write("<sdf>\n<world>\n</sdf>");
  EXPECT_NE(error_of(broken).find("SDF is not well-formed XML"), std::string::npos);
  const auto no_world = write("<sdf/>");
  EXPECT_EQ(error_of(no_world), "SDF file '" + no_world.string() + "' has no <world>");
  const auto file = write(
      "<sdf><world>\n<include><uri>model://a</uri>\n<pose>1 2 nan 0 0 "
      "0</pose></include></world></sdf>");
  EXPECT_EQ(error_of(file),
            file.string() + ":3: <pose> = '1 2 nan 0 0 0', must be 6 finite numbers");
}

TEST(Sdf, StageOneHas21IncludesInRowsThreeMetresApart) {
  VINEROW_OUTSIDE_DATA(folder, "bacchus_lcas/bacchus_gazebo");
  const auto file = folder / "worlds/vineyard_stage1.world";
  const std::vector<SdfInclude> includes = read_sdf_world(file, {}).includes;
  EXPECT_EQ(includes.size(), 21u);
  int vines = 0;
  for (const SdfInclude& include : includes) vines += include.model.rfind("vine_t", 0) == 0;
  EXPECT_EQ(vines, 18);
  const std::vector<std::filesystem::path> search = {folder / "models"};
  SdfInclude wanted;
  wanted.uri = "model://vine_t1";
  wanted.model = "vine_t1";
  EXPECT_FALSE(find_sdf_model(wanted, file.parent_path(), search).has_value());
  wanted.uri = "model://fence_5";
  wanted.model = "fence_5";
  const auto fence = find_sdf_model(wanted, file.parent_path(), search);
  ASSERT_TRUE(fence.has_value());
  const SdfModel model = read_sdf_model(*fence, search);
  ASSERT_EQ(model.meshes.size(), 1u);
  // The model calls itself fence_big; its mesh is found in its own folder all the same.
  EXPECT_TRUE(std::filesystem::exists(model.meshes[0].file)) << model.meshes[0].file;
}

TEST(Sdf, ReadsModelsThatAreWrittenOutInTheWorldAsSaved) {
  VINEROW_OUTSIDE_DATA(folder, "bacchus_lcas/bacchus_gazebo");
  const SdfWorld world =
      read_sdf_world(folder / "worlds/riseholme_ncnr.world", {folder / "models"});
  EXPECT_FALSE(world.origin.has_value()) << "the file has Gazebo's zeros";
  int fences = 0;
  for (const SdfInclude& include : world.includes) {
    if (!include.written_out || include.name.rfind("fence", 0) != 0) continue;
    ++fences;
    ASSERT_EQ(include.written_out->meshes.size(), 1u) << include.name;
    EXPECT_TRUE(std::filesystem::exists(include.written_out->meshes[0].file));
  }
  EXPECT_GE(fences, 6);
}

TEST(Sdf, FindsMeshesWhereTheirUrisPoint) {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_sdf_uris";
  std::filesystem::remove_all(folder);
  for (const char* path : {"tree/meshes/visual/x.obj", "tree/x.obj", "rock/meshes/x.obj"}) {
    std::filesystem::create_directories((folder / path).parent_path());
    std::ofstream(folder / path) << "v 0 0 0\n";
  }
  const auto model_with = [&](const std::string& uri) {
    std::ofstream(folder / "tree/model.sdf")
        << "<sdf version='1.9'><model name='tree'><link name='l'><visual name='v'><geometry><mesh>"
           "<uri>"
        << uri << "</uri></mesh></geometry></visual></link></model></sdf>";
    return read_sdf_model(folder / "tree", {folder}).meshes.at(0).file.lexically_normal();
  };
  EXPECT_EQ(model_with("meshes/visual/x.obj"), folder / "tree/meshes/visual/x.obj");
  EXPECT_EQ(model_with("x.obj"), folder / "tree/x.obj");
  EXPECT_EQ(model_with("file://meshes/visual/x.obj"), folder / "tree/meshes/visual/x.obj");
  EXPECT_EQ(model_with((folder / "rock/meshes/x.obj").string()), folder / "rock/meshes/x.obj");
  EXPECT_EQ(model_with("model://tree/x.obj"), folder / "tree/x.obj");
  EXPECT_EQ(model_with("model://oak/x.obj"), folder / "tree/x.obj") << "renamed copy";
  EXPECT_EQ(model_with("model://rock/meshes/x.obj"), folder / "rock/meshes/x.obj");
}

TEST(Sdf, TakesThePlaceOnEarthAndTurnsTheWorldByItsHeading) {
  const SdfWorld world = read_sdf_world(
      write("<sdf version='1.9'><world name='w'><spherical_coordinates><latitude_deg>49.9"
            "</latitude_deg><longitude_deg>7.25</longitude_deg><elevation>180.5</elevation>"
            "<heading_deg>90</heading_deg></spherical_coordinates><include><uri>model://vine</uri>"
            "<pose>2 0 0 0 0 0</pose></include></world></sdf>"),
      {});
  ASSERT_TRUE(world.origin.has_value());
  EXPECT_DOUBLE_EQ(world.origin->latitude_rad, rad_from_deg(49.9));
  EXPECT_DOUBLE_EQ(world.origin->longitude_rad, rad_from_deg(7.25));
  EXPECT_DOUBLE_EQ(world.origin->altitude_m, 180.5);
  // The file's x axis points north.
  EXPECT_LT((world.includes[0].X_WM.p - Eigen::Vector3d(0, 2, 0)).norm(), 1e-12);
  EXPECT_NEAR(yaw_from_quaternion(world.includes[0].X_WM.q), kPi / 2, 1e-12);
  const auto wrong = write(
      "<sdf><world>\n<spherical_coordinates>\n<latitude_deg>91</latitude_deg>"
      "</spherical_coordinates></world></sdf>");
  EXPECT_EQ(error_of(wrong),
            wrong.string() + ":3: <latitude_deg> = 91, must be between -90 and 90");
}

}  // namespace
}  // namespace vinerow::io::sdf_test
