#include "engine/io/robots/urdf.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "engine/core/error.h"
#include "engine/core/program.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"
#include "tests/support/paths.h"

namespace vinerow::io::urdf_test {
namespace {

const std::filesystem::path kPlain =
    std::filesystem::path(VINEROW_SOURCE_DIR) / "tests/vehicles/data/plain_rover.urdf";

std::filesystem::path write_file(const std::string& name, const std::string& text) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / name;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
  return path;
}

std::string error_of(const std::filesystem::path& file) {
  try {
    load_urdf(file);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

/// PATH with other folders, for a while.
class PathOf {
 public:
  explicit PathOf(const std::string& folders) : before_(std::getenv("PATH")) {
    ::setenv("PATH", folders.c_str(), 1);
  }
  ~PathOf() { ::setenv("PATH", before_.c_str(), 1); }
  PathOf(const PathOf&) = delete;
  PathOf& operator=(const PathOf&) = delete;

 private:
  std::string before_;
};

TEST(Xacro, IsAskedForWhereItIsNotInstalled) {
  const PathOf nothing("/nonexistent");
  const auto source = write_file("x.urdf", "<robot name='a'><link name='${b}'/></robot>");
  EXPECT_EQ(error_of(source), source.string() +
                                  ": a xacro source, not a URDF, and xacro is not installed; "
                                  "expand it elsewhere: xacro " +
                                  source.string() + " > robot.urdf");
  // Without it the robot would silently lack what the file includes.
  const auto include = write_file(
      "include.xacro",
      "<robot name='a' xmlns:xacro='x'><link name='b'/><xacro:include filename='c'/></robot>");
  EXPECT_NE(error_of(include).find("a xacro source, not a URDF"), std::string::npos);
}

TEST(Xacro, SaysItsOwnReason) {
  // A stand-in that fails as xacro does: the reason is on the last line of its standard error.
  const auto program = write_file(
      "bin/xacro", "#!/bin/sh\necho noise >&2\necho name \\'b\\' is not defined >&2\nexit 2\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const PathOf folder(program.parent_path().string() + ":/usr/bin:/bin");
  const auto source = write_file("x.urdf", "<robot name='a'><link name='${b}'/></robot>");
  EXPECT_EQ(error_of(source),
            source.string() + ": xacro cannot expand it: name 'b' is not defined");
}

TEST(Xacro, ExpandsPropertiesAndIncludes) {
  if (!has_program("xacro")) GTEST_SKIP() << "xacro is not installed";
  write_file("arm.xacro",
             "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:macro name='pad' "
             "params='side'><link name='${side}_pad'/></xacro:macro></robot>");
  const auto source = write_file(
      "robot.xacro",
      "<robot name='a' xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:include "
      "filename='arm.xacro'/><link name='base'/><xacro:pad side='left'/><joint name='j' "
      "type='fixed'><parent link='base'/><child link='left_pad'/><origin xyz='${2 * 0.3} 0 "
      "0'/></joint></robot>");
  const UrdfModel model = load_urdf(source);
  ASSERT_EQ(model.links.size(), 2u);
  EXPECT_EQ(model.links[1].name, "left_pad");
  EXPECT_EQ(model.joints[0].X_PJ.p.x(), 0.6);
  EXPECT_EQ(model.notes, std::vector<std::string>{"expanded by xacro"});
}

TEST(Urdf, ReadsLinksJointsAndMaterials) {
  const UrdfModel model = load_urdf(kPlain);
  EXPECT_EQ(model.name, "plain_rover");
  ASSERT_EQ(model.links.size(), 7u);
  ASSERT_EQ(model.joints.size(), 6u);
  EXPECT_EQ(model.links[0].name, "base_footprint");
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    EXPECT_EQ(model.joints[i].child_link, static_cast<int>(i) + 1);
    EXPECT_LE(model.joints[i].parent_link, static_cast<int>(i));
  }
  const UrdfLink& base = model.links[1];
  EXPECT_EQ(base.name, "base_link");
  EXPECT_EQ(base.mass_kg, 30.0);
  EXPECT_EQ(base.inertia_L(2, 2), 2.0);
  ASSERT_EQ(base.visuals.size(), 1u);
  EXPECT_EQ(base.visuals[0].kind, UrdfShapeKind::kBox);
  ASSERT_TRUE(base.visuals[0].colour.has_value());
  EXPECT_NEAR(base.visuals[0].colour->z(), 0.8f, 1e-6f);
}

TEST(Urdf, TakesTheDefaultOfOptenvAndSaysSo) {
  const UrdfModel model = load_urdf(kPlain);
  bool found = false;
  for (const UrdfJoint& joint : model.joints) {
    if (joint.name != "payload_joint") continue;
    found = true;
    EXPECT_NEAR(joint.X_PJ.p.x(), 0.2, 1e-12);
    EXPECT_NEAR(yaw_from_quaternion(joint.X_PJ.q), 0.5 * kPi, 1e-6);
  }
  EXPECT_TRUE(found);
  ASSERT_EQ(model.notes.size(), 1u);
  EXPECT_EQ(model.notes[0], "$(optenv PAYLOAD_XYZ) was replaced by '0.2 0 0.22'");
}

TEST(Urdf, FaultsAreOneClearSentence) {
  EXPECT_EQ(error_of("no/such.urdf"), "URDF file 'no/such.urdf' does not exist or cannot be read");
  const auto broken = write_file("broken.urdf", "<robot name='a'>\n<link name='b'>\n</robot>\n");
  EXPECT_NE(error_of(broken).find("broken.urdf:2: not well-formed XML"), std::string::npos)
      << error_of(broken);
  const auto other = write_file("other.urdf", "<sdf version='1.6'/>");
  EXPECT_NE(error_of(other).find("the outermost element is <sdf>, must be <robot>"),
            std::string::npos);
  const auto empty = write_file("empty.urdf", "<robot name='a'/>");
  EXPECT_NE(error_of(empty).find("not a URDF ("), std::string::npos) << error_of(empty);
  const auto expanded =
      write_file("expanded.urdf", "<robot name='a' xmlns:xacro='x'><link name='b'/></robot>");
  EXPECT_EQ(load_urdf(expanded).links.size(), 1u);
  const auto mesh = write_file("mesh.urdf",
                               "<robot name='a'><link name='b'><visual><geometry><mesh "
                               "filename='gone.stl'/></geometry></visual></link></robot>");
  EXPECT_NE(error_of(mesh).find("link 'b' uses mesh 'gone.stl', which does not exist"),
            std::string::npos);
  const auto package = write_file(
      "package.urdf",
      "<robot name='a'><link name='b'><visual><geometry><mesh "
      "filename='package://nowhere_to_be/gone.stl'/></geometry></visual></link></robot>");
  EXPECT_NE(error_of(package).find("uses package 'nowhere_to_be', whose folder is not known"),
            std::string::npos);
}

/// liburdfdom leaves out the inertial and returns the rest: a robot without its mass.
TEST(Urdf, InertialsWithNumbersThatCannotBeReadAreRefused) {
  const auto robot = [](const std::string& mass, const std::string& ixx) {
    return "<robot name='a'><link name='b'><inertial><mass value='" + mass + "'/><inertia ixx='" +
           ixx + "' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>";
  };
  EXPECT_EQ(load_urdf(write_file("good.urdf", robot("20.5", "1"))).links.at(0).mass_kg, 20.5);
  const auto comma = write_file("comma.urdf", robot("20,5", "1"));
  EXPECT_EQ(error_of(comma),
            comma.string() +
                ": not a URDF (Inertial: mass [20,5] is not a float: Could not parse inertial "
                "element for Link [b])");
  EXPECT_NE(error_of(write_file("nan.urdf", robot("nan", "1"))).find("mass [nan]"),
            std::string::npos);
  EXPECT_NE(error_of(write_file("text.urdf", robot("20", "one"))).find("element for Link [b])"),
            std::string::npos);
  // A visual is for pictures only.
  const auto visual =
      write_file("visual.urdf",
                 "<robot name='a'><link name='b'><inertial><mass value='2'/><inertia ixx='1' "
                 "iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial><visual><geometry><box "
                 "size='1 1 a'/></geometry></visual></link></robot>");
  const UrdfModel model = load_urdf(visual);
  EXPECT_EQ(model.links.at(0).mass_kg, 2.0);
  ASSERT_EQ(model.notes.size(), 1u);
  EXPECT_NE(model.notes[0].find("Could not parse visual element for Link [b]"), std::string::npos)
      << model.notes[0];
}

/// liburdfdom would take the value that it complains about for a format of printf.
TEST(Urdf, APercentSignIsRefusedButInNamesOfFiles) {
  const auto origin = write_file("percent.urdf",
                                 "<robot name='a'>\n<link name='b'><visual>\n<origin xyz='0 "
                                 "%s%s%n 0'/></visual></link></robot>");
  EXPECT_EQ(error_of(origin),
            origin.string() +
                ":3: xyz=\"0 %s%s%n 0\" of <origin>: a '%' is allowed in names of "
                "files only");
  const auto name = write_file("percent.urdf", "<robot name='a'>\n<link name='b%n'/></robot>");
  EXPECT_EQ(error_of(name),
            name.string() + ":2: name=\"b%n\" of <link>: a '%' is allowed in names of files only");
  const auto mesh = write_file("percent.urdf",
                               "<robot name='a'><link name='b'><visual><geometry><mesh "
                               "filename='a%20mesh.stl'/></geometry></visual></link></robot>");
  EXPECT_NE(error_of(mesh).find("link 'b' uses mesh 'a%20mesh.stl', which does not exist"),
            std::string::npos);
}

TEST(Urdf, ReadsForeignRobots) {
  for (const char* name : {"husky/husky.urdf", "racecar/racecar.urdf"}) {
    VINEROW_OUTSIDE_DATA(file, std::filesystem::path("bullet3/data") / name);
    const UrdfModel model = load_urdf(file);
    EXPECT_GT(model.links.size(), 4u) << name;
  }
}

TEST(Urdf, NamesTheMeshThatAForeignRobotLacks) {
  VINEROW_OUTSIDE_DATA(file, "bullet3/data/racecar/racecar_differential.urdf");
  EXPECT_NE(error_of(file).find("uses mesh 'differential/diff_ring.stl', which does not exist"),
            std::string::npos)
      << error_of(file);
}

TEST(Urdf, RepeatedMaterialIsTakenOnceAndSaid) {
  const std::string colour = "<material name='white'><color rgba='1 1 1 1'/></material>";
  const auto file =
      write_file("twice.urdf", "<robot name='a'>" + colour + colour + "<link name='b'/></robot>");
  const UrdfModel model = load_urdf(file);
  ASSERT_EQ(model.notes.size(), 1u);
  EXPECT_EQ(model.notes[0], "material 'white' is defined again; the first definition is used");
}

}  // namespace
}  // namespace vinerow::io::urdf_test
