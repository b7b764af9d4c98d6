#include "engine/io/meshes/mesh_file.h"

#include <fmt/format.h>
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

// A wedge of 1 x 2 x 3 in x, y, z: its extents distinguish the axes.
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

std::size_t triangle_count(const MeshFile& file) {
  std::size_t count = 0;
  for (const MeshPart& part : file.parts) count += part.mesh->triangles.size();
  return count;
}

void expect_extents(const MeshFile& file, double x, double y, double z) {
  // Files hold short decimals; float keeps them to 1e-7 of their size.
  EXPECT_LT((file.bounds().sizes() - Eigen::Vector3d(x, y, z)).norm(), 1e-6)
      << file.bounds().sizes().transpose();
}

TEST_F(MeshFileTest, ObjIsTakenAsZUpMetres) {
  const MeshFile file = load_mesh(write("w.obj", kWedgeObj));
  expect_extents(file, 1, 2, 3);
  EXPECT_EQ(triangle_count(file), 4u);
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
  write("bark.png", "\x89PNG\r\n\x1a\nthe rest is not looked into");
  write("m.mtl", "newmtl bark\nKd 1 1 1\nmap_Kd bark.png\n");
  const MeshFile file =
      load_mesh(write("w.obj", std::string("mtllib m.mtl\nusemtl bark\n") + kWedgeObj));
  EXPECT_TRUE(file.notes.empty());
  EXPECT_EQ(file.parts.front().material.texture, (folder_ / "bark.png").string());
}

TEST_F(MeshFileTest, TextureOfAnotherFormatIsANote) {
  write("bark.tga", "neither");
  write("m.mtl", "newmtl bark\nKd 1 1 1\nmap_Kd bark.tga\n");
  const MeshFile file =
      load_mesh(write("w.obj", std::string("mtllib m.mtl\nusemtl bark\n") + kWedgeObj));
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_EQ(file.notes[0],
            fmt::format("{}: texture '{}' is neither PNG nor JPEG and is not used",
                        (folder_ / "w.obj").string(), (folder_ / "bark.tga").string()));
  EXPECT_EQ(file.parts.front().material.texture, "");
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
  // Readers that skip line ends behind the header swallow a first byte of 0x0a.
  for (const unsigned char low : {0x0a, 0x0d, 0x00, 0x20, 0x41}) {
    float x = -0.25f;
    std::memcpy(&x, &low, 1);
    const MeshFile file = load_mesh(write("p.ply", binary_ply(x)));
    ASSERT_EQ(triangle_count(file), 1u) << int{low};
    EXPECT_EQ(file.parts.front().mesh->vertices[0].x(), x) << int{low};
  }
}

TEST_F(MeshFileTest, PlyThatIsCutOffOrPointsOutsideIsRefused) {
  const std::string whole = binary_ply(-0.25f);
  EXPECT_NE(error_of(write("cut.ply", whole.substr(0, whole.size() - 5)))
                .find("cut.ply' is cut off: element face 1 of 1 is incomplete"),
            std::string::npos);
  EXPECT_NE(error_of(write("cut.ply", whole.substr(0, whole.size() - 20)))
                .find("cut.ply' is cut off: element vertex 3 of 3 is incomplete"),
            std::string::npos);
  EXPECT_NE(error_of(write("cut.ply", whole.substr(0, whole.find("element face"))))
                .find("is cut off: its header has no end_header"),
            std::string::npos);
  std::string outside = whole;
  outside[outside.size() - 4] = 9;
  EXPECT_NE(
      error_of(write("outside.ply", outside)).find("face 1 names vertex 9, it has 3 (0 to 2)"),
      std::string::npos);
}

/// An ascii PLY of four vertices, a square of 1 x 2, and these faces.
std::string square_ply(const std::string& faces, int count) {
  return "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n"
         "property float y\nproperty float z\nelement face " +
         std::to_string(count) +
         "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 2 0\n0 2 0\n" +
         faces;
}

TEST_F(MeshFileTest, BrokenFacesOfAnAsciiPlyAreRefusedByNumber) {
  const auto error = [&](const std::string& face) {
    return error_of(write("f.ply", square_ply("3 0 1 2\n" + face + "\n", 2)));
  };
  const std::string file = "mesh file '" + (folder_ / "f.ply").string() + "' ";
  EXPECT_EQ(error("3 0 -1 2"), file + "is broken: face 2 names vertex -1, it has 4 (0 to 3)");
  EXPECT_EQ(error("3 0 65536 2"), file + "is broken: face 2 names vertex 65536, it has 4 (0 to 3)");
  EXPECT_EQ(error("3 0 99999999 2"),
            file + "is broken: face 2 names vertex 99999999, it has 4 (0 to 3)");
  EXPECT_EQ(error("3 0 1.5 2"), file + "is broken: face 2 names vertex 1.5, it has 4 (0 to 3)");
  EXPECT_EQ(error("3 0 1"), file + "has '' as vertex_indices in line 16, must be a number");
  EXPECT_EQ(
      error("-3 0 1 2"),
      file + "has a list 'vertex_indices' of -3 values in face 2, must be a whole number >= 0");
  EXPECT_EQ(error("3 0 1 2 3"), file + "has more numbers in line 16 than its header names");
  EXPECT_EQ(error("3 0 1 2\n3 0 1 2"), file + "has more data than its header counts");
  EXPECT_EQ(error_of(write("f.ply", square_ply("3 0 1 2\n", 2))),
            file + "is cut off: element face 2 of 2 is incomplete");
}

TEST_F(MeshFileTest, BinaryPlyWithABrokenHeaderIsRefused) {
  const std::string whole = binary_ply(-0.25f);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    return error_of(write("h.ply", text));
  };
  // 49 bytes hold four vertices of 12.
  EXPECT_NE(changed("vertex 3", "vertex 9999999999").find("element vertex 5 of 9999999999"),
            std::string::npos);
  EXPECT_NE(changed("face 1", "face 2").find("element face 2 of 2 is incomplete"),
            std::string::npos);
  EXPECT_NE(changed("list uchar int", "list uchxr int").find("has the unknown type 'uchxr'"),
            std::string::npos);
  EXPECT_NE(changed("property float z", "property float w").find("vertices without x, y and z"),
            std::string::npos);
  EXPECT_NE(changed("vertex_indices", "vertex_indicex").find("without a list vertex_indices"),
            std::string::npos);
  std::string counted = whole;
  counted[counted.size() - 13] = '\xff';  // corners of the face
  EXPECT_NE(error_of(write("h.ply", counted)).find("element face 1 of 1 is incomplete"),
            std::string::npos);
}

TEST_F(MeshFileTest, PlyPolygonsAreCutIntoTriangles) {
  const auto area_of = [](const TriangleMesh& mesh) {
    Eigen::Vector3f area = Eigen::Vector3f::Zero();
    float parts = 0.0f;
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3f& a = mesh.vertices[t[0]];
      const Eigen::Vector3f n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a) / 2.0f;
      area += n;
      parts += n.norm();
    }
    EXPECT_FLOAT_EQ(area.z(), parts);  // none turned over, none outside
    return parts;
  };
  const MeshFile square = load_mesh(write("q.ply", square_ply("4 0 1 2 3\n", 1)));
  EXPECT_EQ(triangle_count(square), 2u);
  EXPECT_FLOAT_EQ(area_of(*square.parts[0].mesh), 2.0f);
  // An L and an arrow whose fan from the first corner would leave the polygon: areas by the
  // shoelace formula, 3 and 3.
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar uint vertex_index\nend_header\n";
  const MeshFile ell = load_mesh(
      write("l.ply", header + "0 2 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n6 0 1 2 3 4 5\n"));
  EXPECT_EQ(triangle_count(ell), 4u);
  EXPECT_FLOAT_EQ(area_of(*ell.parts[0].mesh), 3.0f);
  const MeshFile arrow =
      load_mesh(write("a.ply", header + "4 0 0\n0 2 0\n1 0 0\n0 -2 0\n0 0 9\n0 0 9\n4 0 1 2 3\n"));
  EXPECT_EQ(triangle_count(arrow), 2u);
  EXPECT_FLOAT_EQ(area_of(*arrow.parts[0].mesh), 6.0f);
}

TEST_F(MeshFileTest, PlyStripsCornersAndSharedVerticesAreRead) {
  const std::string vertices = "0 0 0\n1 0 0\n0 2 0\n1 2 0\n0 0 0\n";  // the last equals the first
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\n";
  const MeshFile strip = load_mesh(write(
      "s.ply", header + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                   vertices + "8 0 1 2 3 -1 4 1 2\n"));
  ASSERT_EQ(triangle_count(strip), 3u);
  EXPECT_EQ(strip.parts[0].mesh->vertices.size(), 4u);
  for (const auto& t : strip.parts[0].mesh->triangles) {
    const auto& v = strip.parts[0].mesh->vertices;
    EXPECT_GT((v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).z(), 0.0f);
  }
  // Two faces with other texture coordinates at the same vertex: it is there twice.
  const MeshFile corners =
      load_mesh(write("c.ply", header +
                                   "element face 2\nproperty list uchar int vertex_indices\n"
                                   "property list uchar float texcoord\nend_header\n" +
                                   vertices + "3 0 1 2 6 0 0 1 0 0 1\n3 1 3 2 6 0.5 0 1 1 0 1\n"));
  const TriangleMesh& mesh = *corners.parts[0].mesh;
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.uvs[mesh.triangles[0][1]], Eigen::Vector2f(1.0f, 0.0f));
  EXPECT_EQ(mesh.uvs[mesh.triangles[1][0]], Eigen::Vector2f(0.5f, 0.0f));
  EXPECT_EQ(mesh.vertices[mesh.triangles[1][0]], mesh.vertices[mesh.triangles[0][1]]);
}

TEST_F(MeshFileTest, PlyColoursAreLinearWhereTheyAreRealNumbers) {
  const auto colour_of = [&](const std::string& type, const std::string& value) {
    const std::string c = " " + value + " " + value + " " + value + "\n";
    const MeshFile file = load_mesh(
        write("k.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nproperty " +
                  type + " red\nproperty " + type + " green\nproperty " + type +
                  " blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                  "0 0 0" +
                  c + "1 0 0" + c + "0 1 0" + c + "3 0 1 2\n"));
    const auto& colours = file.parts[0].mesh->colours;
    return colours.empty() ? -1.0f : colours[0].x();
  };
  EXPECT_EQ(colour_of("float", "0.5"), 0.5f);
  // sRGB of IEC 61966-2-1: ((0.5 + 0.055) / 1.055)^2.4 and ((51 / 255 + 0.055) / 1.055)^2.4
  EXPECT_NEAR(colour_of("uchar", "51"), 0.0331048f, 1e-6);
  EXPECT_NEAR(colour_of("ushort", "13107"), 0.0331048f, 1e-6);
  EXPECT_EQ(colour_of("int", "51"), -1.0f);
}

TEST_F(MeshFileTest, ColladaThatPromisesMoreThanItHoldsIsRefused) {
  const std::string whole = wedge_dae("Z_UP", "1");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    return error_of(write("w.dae", text));
  };
  const std::string file = "mesh file '" + (folder_ / "w.dae").string() + "' ";
  EXPECT_EQ(changed("count=\"12\"", "count=\"1999999999\""),
            file +
                "is broken: count = '1999999999' of <float_array> in line 1, must be a whole "
                "number up to " +
                std::to_string(whole.size() + 8) + ", the file's bytes");
  EXPECT_NE(
      changed("<triangles count=\"4\"", "<triangles count=\"-4\"").find("count = '-4' of <tri"),
      std::string::npos);
  EXPECT_NE(changed("offset=\"0\"", "offset=\"99999999\"").find("offset = '99999999' of <input>"),
            std::string::npos);
  EXPECT_NE(changed("stride=\"3\"", "stride=\"3000000\"").find("stride = '3000000' of <accessor>"),
            std::string::npos);
  EXPECT_EQ(changed("<p>0 2 1", "<p>0 ~ 1"),
            file + "is broken: '~' in <p> of line 1, must be a whole number up to " +
                std::to_string(whole.size()) + ", the file's bytes");
  EXPECT_NE(changed("<p>0 2 1", "<p>0 -4 1").find("'-4' in <p> of line 1"), std::string::npos);
  EXPECT_EQ(changed("0 0 0 1 0", "0 0 0 1e999 0"),
            file + "is broken: '1e999' in <float_array> of line 1, must be a finite number");
  EXPECT_EQ(changed("0 0 0 1 0", "0 0 1 0"),
            file + "is broken: <float_array> of line 1 has 11 numbers, its count is 12");
  // Four corners of three numbers are taken from arrays that are counted as shorter.
  EXPECT_EQ(changed("count=\"12\"", "count=\"0\""),
            file +
                "is broken: the <accessor> of line 1 takes 12 values from the 0 of the "
                "<float_array> of line 1");
  EXPECT_NE(changed("count=\"12\"", "count=\"11\"").find("takes 12 values from the 11 of the"),
            std::string::npos);
  EXPECT_NE(changed("stride=\"3\"", "stride=\"4\"").find("takes 15 values from the 12 of the"),
            std::string::npos);
  EXPECT_NE(changed("<instance_geometry url=\"#g\"/>", "<instance_node url=\"#n\"/>")
                .find("is broken: the node 'n' contains itself"),
            std::string::npos);
  // 30 nodes, each of which stands twice in the next: 2^30 in all.
  std::string nodes = "<node id=\"k0\"><instance_geometry url=\"#g\"/></node>";
  for (int i = 1; i <= 30; ++i) {
    const std::string below = "<instance_node url=\"#k" + std::to_string(i - 1) + "\"/>";
    nodes += "<node id=\"k" + std::to_string(i) + "\">" + below + below + "</node>";
  }
  EXPECT_NE(changed("<instance_geometry url=\"#g\"/></node>",
                    "<instance_node url=\"#k30\"/></node>" + nodes)
                .find("is broken: its nodes instance each other more than 1000000 times"),
            std::string::npos);
}

/// assimp reads the <COLLADA> that stands behind another element: unchecked, it took 40 GB of
/// memory.
TEST_F(MeshFileTest, ColladaIsTheOneOutermostElement) {
  const std::string whole = wedge_dae("Z_UP", "1");
  const std::string declaration = "<?xml version=\"1.0\"?>";
  ASSERT_EQ(whole.rfind(declaration, 0), 0u);
  const std::string collada = whole.substr(declaration.size());
  const std::string file = "mesh file '" + (folder_ / "w.dae").string() + "' cannot be read: ";
  EXPECT_EQ(error_of(write("w.dae", declaration + "\n<asset/>\n" + collada)),
            file + "its outermost element is <asset> (line 2), must be <COLLADA>");
  EXPECT_EQ(
      error_of(write("w.dae", declaration + "\n" + collada + "\n<asset/>\n")),
      file + "<asset> (line 3) is next to <COLLADA>, but a document has one outermost element");
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

// A post of 0.2 m at coordinates of UTM: the step of a 32-bit northing is 0.5 m there (2^22 to 2^23
// m, 24 bits), so that its sides coincide.
TEST_F(MeshFileTest, CoordinatesThatAreTooCoarseAreRefused) {
  const std::string post =
      "o post\nv 499999.9 4899999.9 0\nv 500000.1 4899999.9 0\nv 500000 4900000.1 0\n"
      "v 500000 4900000 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string error = error_of(write("utm.obj", post));
  EXPECT_NE(error.find("utm.obj': vertex 0 of 'post' is 4900000 m from the file's origin, must be "
                       "at most 100000 m"),
            std::string::npos)
      << error;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 100001 0\n3 0 1 2\n";
  EXPECT_NE(error_of(write("far.ply", ply)).find("vertex 2 of 'far' is 100001 m"),
            std::string::npos);
  // 4.9e6 millimetres are 4.9 km, with steps of 0.5 mm.
  MeshFileOptions millimetres;
  millimetres.unit_m = 1e-3;
  EXPECT_NEAR(load_mesh(write("mm.obj", post), millimetres).bounds().max().y(), 4900.0, 1e-3);
}

TEST_F(MeshFileTest, ConeOfTwoFormatsIsTheSameBody) {
  VINEROW_OUTSIDE_DATA(meshes, "bullet3/data/racecar/meshes");
  const MeshFile dae = load_mesh(meshes / "cone.dae");
  const MeshFile obj = load_mesh(meshes / "cone.obj");
  // The OBJ is rounded to micrometres, the DAE to 1e-6 inch.
  EXPECT_LT((dae.bounds().min() - obj.bounds().min()).norm(), 2e-5);
  EXPECT_LT((dae.bounds().max() - obj.bounds().max()).norm(), 2e-5);
  EXPECT_NEAR(dae.bounds().max().z(), 0.17, 1e-5);
  EXPECT_EQ(triangle_count(dae), triangle_count(obj));
}

TEST_F(MeshFileTest, OrchardGroundLoadsAndTellsItsMissingTexture) {
  VINEROW_OUTSIDE_DATA(file, "cpr_gazebo/cpr_orchard_gazebo/meshes/orchard_world.dae");
  const MeshFile ground = load_mesh(file);
  EXPECT_EQ(triangle_count(ground), 3648u);  // data/README.md
  EXPECT_NEAR(ground.bounds().min().z(), -0.10, 0.005);
  EXPECT_NEAR(ground.bounds().max().z(), 0.07, 0.005);
  ASSERT_EQ(ground.notes.size(), 1u);
  EXPECT_NE(ground.notes[0].find("texture 'Ground.png'"), std::string::npos) << ground.notes[0];
}

TEST_F(MeshFileTest, ObstacleCourseHasTheKnownSize) {
  VINEROW_OUTSIDE_DATA(file, "cpr_gazebo/cpr_obstacle_gazebo/models/obstacle_world.stl");
  const MeshFile course = load_mesh(file);
  EXPECT_EQ(triangle_count(course), 680u);
  EXPECT_LT((course.bounds().sizes() - Eigen::Vector3d(12.3, 8.3, 2.6)).cwiseAbs().maxCoeff(),
            0.05);
}

}  // namespace
}  // namespace vinerow::io::mesh_file_test
