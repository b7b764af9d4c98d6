#include "engine/io/mesh_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "engine/core/error.h"
#include "tests/support/data.h"

namespace vinerow::io::mesh_file_test {
namespace {

class MeshFileTest : public ::testing::Test {
 protected:
  MeshFileTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / "vinerow_mesh_file_test" / test->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~MeshFileTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  static std::string error_of(const std::filesystem::path& file,
                              const MeshFileOptions& options = {}) {
    try {
      load_mesh(file, options);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "no error";
  }
  std::filesystem::path folder_;
};

// A wedge of 1 x 2 x 3 in x, y, z: its extents tell the axes apart.
const char* const kWedgeObj =
    "o wedge\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n"
    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

std::string wedge_dae(const std::string& up_axis, const std::string& unit) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset><unit name=\"u\" meter=\"" +
         unit + "\"/><up_axis>" + up_axis +
         "</up_axis></asset><library_geometries><geometry id=\"g\" name=\"g\"><mesh><source "
         "id=\"p\"><float_array id=\"a\" count=\"12\">0 0 0 1 0 0 0 2 0 0 0 3</float_array>"
         "<technique_common><accessor source=\"#a\" count=\"4\" stride=\"3\"><param name=\"X\" "
         "type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
         "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
         "source=\"#p\"/></vertices><triangles count=\"4\"><input semantic=\"VERTEX\" "
         "source=\"#v\" offset=\"0\"/><p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles></mesh></geometry>"
         "</library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\" "
         "name=\"wedge\"><instance_geometry url=\"#g\"/></node></visual_scene>"
         "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    volume += a.dot(mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>()));
  }
  return volume / 6.0;
}

void expect_extents(const MeshFile& file, double x, double y, double z) {
  // Files hold short decimals; float keeps them to 1e-7 of their size.
  EXPECT_LT((file.bounds().sizes() - Eigen::Vector3d(x, y, z)).norm(), 1e-6)
      << file.bounds().sizes().transpose();
}

TEST_F(MeshFileTest, ObjIsTakenAsZUpMetres) {
  const MeshFile file = load_mesh(write("w.obj", kWedgeObj));
  expect_extents(file, 1, 2, 3);
  EXPECT_EQ(file.triangle_count(), 4u);
  EXPECT_TRUE(file.notes.empty());
  // Outward faces: the volume of the tetrahedron 1*2*3/6, positive.
  EXPECT_NEAR(signed_volume(merge_parts(file)), 1.0, 1e-6);
}

TEST_F(MeshFileTest, YUpTurnsYToZAndKeepsHandedness) {
  MeshFileOptions options;
  options.up_axis = UpAxis::kY;
  const MeshFile file = load_mesh(write("w.obj", kWedgeObj), options);
  expect_extents(file, 1, 3, 2);
  EXPECT_NEAR(file.bounds().min().y(), -3.0, 1e-6);  // (x, y, z) -> (x, -z, y)
  EXPECT_NEAR(signed_volume(merge_parts(file)), 1.0, 1e-6);
}

TEST_F(MeshFileTest, ZUpColladaStaysUpright) {
  expect_extents(load_mesh(write("z.dae", wedge_dae("Z_UP", "1"))), 1, 2, 3);
}

TEST_F(MeshFileTest, YUpAndXUpColladaAreTurned) {
  expect_extents(load_mesh(write("y.dae", wedge_dae("Y_UP", "1"))), 1, 3, 2);
  const MeshFile x_up = load_mesh(write("x.dae", wedge_dae("X_UP", "1")));
  EXPECT_NEAR(x_up.bounds().sizes().z(), 1.0, 1e-6);
  EXPECT_NEAR(x_up.bounds().max().z(), 1.0, 1e-6);
  EXPECT_NEAR(signed_volume(merge_parts(x_up)), 1.0, 1e-6);
}

TEST_F(MeshFileTest, ColladaUnitCountsUnlessTheCallerKnowsBetter) {
  const auto file = write("i.dae", wedge_dae("Z_UP", "0.0254"));
  expect_extents(load_mesh(file), 0.0254, 0.0508, 0.0762);
  MeshFileOptions options;
  options.unit_m = 0.01;
  expect_extents(load_mesh(file, options), 0.01, 0.02, 0.03);
}

TEST_F(MeshFileTest, MirrorTurnsFacesBackOutside) {
  MeshFileOptions options;
  options.scale = {1.0, -2.0, 1.0};
  const MeshFile file = load_mesh(write("w.obj", kWedgeObj), options);
  EXPECT_NEAR(signed_volume(merge_parts(file)), 2.0, 1e-6);
}

TEST_F(MeshFileTest, MissingTextureAndLibraryAreNotedByName) {
  write("there.mtl", "newmtl bark\nmap_Kd bark.png\n");
  const auto file =
      write("w.obj", std::string("mtllib there.mtl\nmtllib gone.mtl\nusemtl bark\n") + kWedgeObj);
  const MeshFile loaded = load_mesh(file);
  std::string notes;
  for (const std::string& note : loaded.notes) notes += note + "\n";
  EXPECT_NE(notes.find("material library 'gone.mtl' is missing"), std::string::npos) << notes;
  EXPECT_NE(notes.find("texture 'bark.png' of material 'bark' is missing"), std::string::npos)
      << notes;
  EXPECT_EQ(loaded.parts.front().material.texture, "");
}

TEST_F(MeshFileTest, TextureThatIsThereBecomesAnAbsolutePath) {
  write("bark.png", "not looked into");
  write("m.mtl", "newmtl bark\nKd 1 1 1\nmap_Kd bark.png\n");
  const MeshFile file =
      load_mesh(write("w.obj", std::string("mtllib m.mtl\nusemtl bark\n") + kWedgeObj));
  EXPECT_TRUE(file.notes.empty());
  EXPECT_EQ(file.parts.front().material.texture, (folder_ / "bark.png").string());
}

std::string binary_ply(float first_x) {
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const float coordinates[9] = {first_x, 0, 0, 1, 0, 0, 0, 2, 0};
  const int indices[3] = {0, 1, 2};
  ply.append(reinterpret_cast<const char*>(coordinates), sizeof coordinates);
  ply += '\3';
  ply.append(reinterpret_cast<const char*>(indices), sizeof indices);
  return ply;
}

TEST_F(MeshFileTest, PlyWhoseDataBeginsWithALineFeedIsReadRight) {
  // assimp 5.2 swallows a first byte of 0x0a and shifts what follows.
  for (const unsigned char low : {0x0a, 0x0d, 0x00, 0x20, 0x41}) {
    float x = -0.25f;
    std::memcpy(&x, &low, 1);
    const MeshFile file = load_mesh(write("p.ply", binary_ply(x)));
    ASSERT_EQ(file.triangle_count(), 1u) << int{low};
    EXPECT_EQ(file.parts.front().mesh->vertices[0].x(), x) << int{low};
  }
}

TEST_F(MeshFileTest, PlyThatIsCutOffOrPointsOutsideIsRefused) {
  const std::string whole = binary_ply(-0.25f);
  EXPECT_NE(error_of(write("cut.ply", whole.substr(0, whole.size() - 5)))
                .find("cut.ply' is cut off: element face 1 of 1 is not whole"),
            std::string::npos);
  EXPECT_NE(error_of(write("cut.ply", whole.substr(0, whole.size() - 20)))
                .find("cut.ply' is cut off: element vertex 3 of 3 is not whole"),
            std::string::npos);
  EXPECT_NE(error_of(write("cut.ply", whole.substr(0, 60))).find("its header has no 'end_header'"),
            std::string::npos);
  std::string outside = whole;
  outside[outside.size() - 4] = 9;
  EXPECT_NE(
      error_of(write("outside.ply", outside)).find("face 1 names vertex 9, it has 3 (0 to 2)"),
      std::string::npos);
}

TEST_F(MeshFileTest, BadFilesAreRefusedInOneSentence) {
  EXPECT_EQ(error_of(folder_ / "none.stl"),
            "mesh file '" + (folder_ / "none.stl").string() + "' does not exist");
  EXPECT_EQ(error_of(write("empty.obj", "")),
            "mesh file '" + (folder_ / "empty.obj").string() + "' is empty (0 bytes)");
  EXPECT_NE(error_of(write("w.xyz", "x")).find("has the unknown format '.xyz', must be one of"),
            std::string::npos);
  EXPECT_NE(error_of(write("broken.dae", "<COLLADA")).find("cannot be read"), std::string::npos);
  EXPECT_NE(error_of(write("points.ply",
                           "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty "
                           "float y\nproperty float z\nend_header\n1 2 3\n"))
                .find("points.ply' "),
            std::string::npos);
}

TEST_F(MeshFileTest, MeshOfNoTrianglesIsRefused) {
  EXPECT_EQ(error_of(write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")),
            "mesh file '" + (folder_ / "lines.obj").string() + "' has no triangles");
  EXPECT_EQ(error_of(write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")),
            "mesh file '" + (folder_ / "flat.obj").string() + "' has no triangles");
  const std::string error = error_of(write("none.stl", "solid none\nendsolid none\n"));
  EXPECT_TRUE(error.find("none.stl' has no triangles") != std::string::npos ||
              error.find("none.stl' cannot be read") != std::string::npos)
      << error;
}

TEST_F(MeshFileTest, CoordinateThatIsNotFiniteIsRefused) {
  const std::string error = error_of(
      write("nan.stl",
            "solid n\nfacet normal 0 0 1\nouter loop\nvertex nan 0 0\nvertex 1 0 0\nvertex 0 1 "
            "0\nendloop\nendfacet\nendsolid n\n"));
  EXPECT_NE(error.find("has a coordinate that is not finite"), std::string::npos) << error;
}

TEST_F(MeshFileTest, ConeOfTwoFormatsIsTheSameBody) {
  VINEROW_OUTSIDE_DATA(meshes, "bullet3/data/racecar/meshes");
  const MeshFile dae = load_mesh(meshes / "cone.dae");
  const MeshFile obj = load_mesh(meshes / "cone.obj");
  // The OBJ is rounded to micrometres, the DAE to 1e-6 inch.
  EXPECT_LT((dae.bounds().min() - obj.bounds().min()).norm(), 2e-5);
  EXPECT_LT((dae.bounds().max() - obj.bounds().max()).norm(), 2e-5);
  EXPECT_NEAR(dae.bounds().max().z(), 0.17, 1e-5);
  EXPECT_EQ(dae.triangle_count(), obj.triangle_count());
}

TEST_F(MeshFileTest, OrchardGroundLoadsAndTellsItsMissingTexture) {
  VINEROW_OUTSIDE_DATA(file, "cpr_gazebo/cpr_orchard_gazebo/meshes/orchard_world.dae");
  const MeshFile ground = load_mesh(file);
  EXPECT_EQ(ground.triangle_count(), 3648u);  // data/README.md
  EXPECT_NEAR(ground.bounds().min().z(), -0.10, 0.005);
  EXPECT_NEAR(ground.bounds().max().z(), 0.07, 0.005);
  ASSERT_EQ(ground.notes.size(), 1u);
  EXPECT_NE(ground.notes[0].find("texture 'Ground.png'"), std::string::npos) << ground.notes[0];
}

TEST_F(MeshFileTest, ObstacleCourseHasTheKnownSize) {
  VINEROW_OUTSIDE_DATA(file, "cpr_gazebo/cpr_obstacle_gazebo/models/obstacle_world.stl");
  const MeshFile course = load_mesh(file);
  EXPECT_EQ(course.triangle_count(), 680u);
  EXPECT_LT((course.bounds().sizes() - Eigen::Vector3d(12.3, 8.3, 2.6)).cwiseAbs().maxCoeff(),
            0.05);
}

}  // namespace
}  // namespace vinerow::io::mesh_file_test
