/// Descriptions of all vehicles. The judges are not ours: urdfdom's check_urdf reads the text,
/// assimp the meshes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "engine/api/registry.h"
#include "engine/api/vehicle.h"
#include "engine/core/program.h"
#include "engine/io/meshes/mesh_file.h"
#include "engine/io/robots/urdf.h"
#include "engine/io/robots/urdf_writer.h"
#include "engine/live/robot_description.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"
#include "tests/engine/live/live_support.h"
#include "tests/scenarios/command.h"
#include "tests/support/paths.h"

namespace vinerow::live::robot_description_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using test::all_parts;

/// A run with one vehicle of a type, named "rover".
std::unique_ptr<Simulation> run_with(const std::string& type) {
  std::string text = std::string(R"(
vinerow: 1
name: described
duration_s: 1
world: {type: vineyard, row_count: 2, row_length_m: 20, pitch_m: 8, relief_m: 0, waves_m: 0, leaf_cards_per_m: 10, plant_variants: 1}
vehicles:
  rover:
    spawn: {alley: 0, turn_deg: 30}
    type: )") + type +
                     "\n";
  if (type == "urdf_rover") {
    text += "    urdf: " VINEROW_SOURCE_DIR "/tests/vehicles/data/plain_four_steered.urdf\n";
  }
  return std::make_unique<Simulation>(scenario::parse_scenario(text, ".", all_parts()),
                                      all_parts());
}

const Vehicle& vehicle_of(const Simulation& run) {
  return run.vehicles().front()->vehicle();
}

/// Area of each colour, m2, by sRGB in 8 bits.
using Areas = std::map<std::array<long, 3>, double>;

void add_triangle(const TriangleMesh& mesh, std::size_t index, const Eigen::Vector3f& linear,
                  Areas& areas) {
  std::array<long, 3> key;
  for (int i = 0; i < 3; ++i) {
    const double c = linear[i];
    const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
    key[static_cast<std::size_t>(i)] = std::lround(255.0 * srgb);
  }
  const auto& [a, b, c] = mesh.triangles[index];
  const Eigen::Vector3d ab = (mesh.vertices[b] - mesh.vertices[a]).cast<double>();
  const Eigen::Vector3d ac = (mesh.vertices[c] - mesh.vertices[a]).cast<double>();
  areas[key] += 0.5 * ab.cross(ac).norm();
}

Areas areas_of(const VehicleLink& link) {
  Areas areas;
  for (std::size_t i = 0; i < link.mesh->triangles.size(); ++i) {
    Eigen::Vector3f colour = link.material.colour;
    if (!link.mesh->colours.empty()) {
      colour = colour.cwiseProduct(link.mesh->colours[link.mesh->triangles[i][0]]);
    }
    add_triangle(*link.mesh, i, colour, areas);
  }
  return areas;
}

Areas areas_of(const io::MeshFile& file) {
  Areas areas;
  for (const io::MeshPart& part : file.parts) {
    for (std::size_t i = 0; i < part.mesh->triangles.size(); ++i) {
      add_triangle(*part.mesh, i, part.material.colour, areas);
    }
  }
  return areas;
}

void expect_same_shape(const VehicleLink& link, const std::filesystem::path& file) {
  io::MeshFileOptions options;
  options.up_axis = io::UpAxis::kZ;  // as RViz reads it
  const io::MeshFile read = io::load_mesh(file, options);
  EXPECT_LT((read.bounds().min() - link.mesh->bounds().min()).norm(), 1e-6);
  EXPECT_LT((read.bounds().max() - link.mesh->bounds().max()).norm(), 1e-6);
  EXPECT_EQ(io::load_mesh(file).bounds().max(), read.bounds().max()) << "z up in the file, too";
  const Areas wanted = areas_of(link), found = areas_of(read);
  ASSERT_EQ(found.size(), wanted.size());
  for (const auto& [colour, area_m2] : wanted) {
    ASSERT_TRUE(found.contains(colour)) << colour[0] << " " << colour[1] << " " << colour[2];
    EXPECT_NEAR(found.at(colour), area_m2, 1e-4 * area_m2 + 1e-9);
  }
}

TEST(RobotDescription, HasLinksMeshesAndColoursOfEveryVehicle) {
  for (const std::string& type : all_parts().names(PartKind::kVehicle)) {
    SCOPED_TRACE(type);
    const test::ScratchFolder out("robot_description");
    const auto run = run_with(type);
    const Vehicle& vehicle = vehicle_of(*run);
    const std::string text = describe_robot("rover", vehicle, out.path());
    const auto file = out.path() / "robot_description" / "rover.urdf";
    EXPECT_EQ(test::read_text(file), text);

    const io::UrdfModel urdf = io::load_urdf(file);
    EXPECT_EQ(urdf.name, "rover");
    EXPECT_EQ(urdf.links.front().name, "base_link");
    ASSERT_EQ(urdf.links.size(), vehicle.links().size() + 1);
    Odometry truth;
    vehicle.read_truth(truth);
    std::vector<Pose> X_WL(vehicle.links().size());
    vehicle.read_links(X_WL);
    std::size_t colours = 0;
    std::uintmax_t bytes = 0;
    for (std::size_t i = 0; i < vehicle.links().size(); ++i) {
      const VehicleLink& link = vehicle.links()[i];
      SCOPED_TRACE(link.name);
      const auto found = std::ranges::find(urdf.links, link.name, &io::UrdfLink::name);
      ASSERT_NE(found, urdf.links.end());
      const io::UrdfJoint& joint = urdf.joints[static_cast<std::size_t>(found->parent_joint)];
      EXPECT_EQ(joint.kind, io::UrdfJointKind::kFloating);
      EXPECT_EQ(joint.parent_link, 0);
      const Pose X_BL = truth.X_WB.inverse() * X_WL[i];
      EXPECT_LT((joint.X_PJ.p - X_BL.p).norm(), 1e-8);
      EXPECT_LT(joint.X_PJ.q.angularDistance(X_BL.q), 1e-7);
      EXPECT_EQ(found->mass_kg, 0.0) << "unknown, not invented";
      ASSERT_EQ(found->visuals.size(), 1u);
      expect_same_shape(link, found->visuals.front().mesh_file);
      colours += areas_of(link).size();
      bytes += std::filesystem::file_size(found->visuals.front().mesh_file);
    }
    std::printf("%s: %zu links, %zu colours, %.2f MB\n", type.c_str(), vehicle.links().size(),
                colours, 1e-6 * static_cast<double>(bytes));
  }
}

TEST(RobotDescription, IsAUrdfForOthers) {
  if (!has_program("check_urdf")) {
    GTEST_SKIP() << "check_urdf is not installed (Debian: liburdfdom-tools)";
  }
  for (const std::string& type : all_parts().names(PartKind::kVehicle)) {
    SCOPED_TRACE(type);
    const test::ScratchFolder out("check_urdf");
    const auto run = run_with(type);
    describe_robot("rover", vehicle_of(*run), out.path());
    const ProgramOutput judged =
        run_program({"check_urdf", (out.path() / "robot_description" / "rover.urdf").string()});
    EXPECT_TRUE(judged.succeeded) << judged.complaint;
    EXPECT_THAT(judged.output,
                HasSubstr("root Link: base_link has " +
                          std::to_string(vehicle_of(*run).links().size()) + " child(ren)"));
  }
}

TEST(RobotDescription, IsTheSameForTheSameVehicle) {
  const test::ScratchFolder out("same_description");
  const auto run = run_with("quadrotor");
  const std::string text = describe_robot("rover", vehicle_of(*run), out.path());
  const auto file =
      out.path() / "robot_description" / "rover" / (vehicle_of(*run).links().front().name + ".dae");
  const std::string mesh = test::read_text(file);
  ASSERT_NE(mesh, "");
  EXPECT_EQ(describe_robot("rover", vehicle_of(*run), out.path()), text);
  EXPECT_EQ(test::read_text(file), mesh);
}

TEST(RobotDescription, HasNoMeshesWithoutAFolder) {
  const auto run = run_with("diff_drive_rover");
  const std::string text = describe_robot("rover", vehicle_of(*run), {});
  EXPECT_THAT(text, HasSubstr("<link name=\"wheel_fl\"/>"));
  EXPECT_THAT(text, Not(HasSubstr("mesh")));
}

/// A vehicle of a plug-in, with links of any name.
class StrangeVehicle final : public Vehicle {
 public:
  explicit StrangeVehicle(const std::vector<std::string>& names) {
    const auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh->triangles = {{0, 1, 2}};
    for (const std::string& name : names) links_.push_back({name, mesh, {}});
  }
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld&, const Pose&) override {}
  void connect(Ports&) override {}
  void actuate(std::span<const double>) override {}
  void before_physics(Time, Duration) override {}
  void after_physics(Time, Duration) override {}
  void read_truth(Odometry&) const override {}
  Eigen::Vector3d specific_force_B() const override { return {0, 0, 0}; }
  void read_links(std::vector<Pose>&) const override {}
  void publish(Time) override {}

 private:
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
};

TEST(RobotDescription, WritesNowhereElseAndEscapesNames) {
  const test::ScratchFolder scratch("strange_links");
  const auto out = scratch.path() / "a b" / "ü%&";
  std::filesystem::create_directories(out);
  const StrangeVehicle vehicle({"../../../up", "..", "a<b & \"c\"", "base_link", "twice", "twice"});
  const std::string text = describe_robot("rover", vehicle, out);
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch.path())) {
    if (!entry.is_regular_file()) continue;
    files.push_back(entry.path().lexically_relative(out / "robot_description").string());
  }
  EXPECT_THAT(files,
              ::testing::UnorderedElementsAre("rover.urdf", "rover/..%2F..%2F..%2Fup.dae",
                                              "rover/...dae", "rover/a%3Cb%20%26%20%22c%22.dae",
                                              "rover/base_link.dae", "rover/twice.dae"));
  EXPECT_THAT(text, HasSubstr("/a%20b/%C3%BC%25%26/robot_description/rover/base_link.dae\""));
  EXPECT_THAT(text, HasSubstr("/rover/..%252F..%252F..%252Fup.dae\""));
  EXPECT_THAT(text, HasSubstr("<link name=\"a&lt;b &amp; &quot;c&quot;\">"));
  if (!has_program("check_urdf")) return;
  const ProgramOutput judged =
      run_program({"check_urdf", (out / "robot_description" / "rover.urdf").string()});
  EXPECT_TRUE(judged.succeeded) << judged.complaint;
  EXPECT_THAT(judged.output, HasSubstr("root Link: base_link has 4 child(ren)"));
}

}  // namespace
}  // namespace vinerow::live::robot_description_test
