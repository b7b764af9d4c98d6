#include "engine/io/sdf.h"

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
    read_sdf_includes(file);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Sdf, ReadsPosesOfIncludes) {
  const auto includes = read_sdf_includes(write(
      "<sdf version='1.6'><world name='w'>\n<include><uri>model://vine</uri>\n<pose>1 2 3 0 0 "
      "1.5707963267948966</pose><name>a</name></include>\n<include><uri>model://vine</uri></"
      "include>"
      "</world></sdf>"));
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
  const auto includes = read_sdf_includes(folder / "worlds/vineyard_stage1.world");
  EXPECT_EQ(includes.size(), 21u);
  int vines = 0;
  for (const SdfInclude& include : includes) vines += include.model.rfind("vine_t", 0) == 0;
  EXPECT_EQ(vines, 18);
  EXPECT_FALSE(find_sdf_model("vine_t1", {folder / "models"}).has_value());
  const auto fence = find_sdf_model("fence_5", {folder / "models"});
  ASSERT_TRUE(fence.has_value());
  const auto meshes = read_sdf_meshes(*fence);
  ASSERT_EQ(meshes.size(), 1u);
  // The model calls itself fence_big; its mesh is found in its own folder all the same.
  EXPECT_TRUE(std::filesystem::exists(meshes[0].file)) << meshes[0].file;
}

}  // namespace
}  // namespace vinerow::io::sdf_test
