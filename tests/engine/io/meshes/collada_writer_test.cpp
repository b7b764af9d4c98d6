#include "engine/io/meshes/collada_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "engine/core/error.h"
#include "engine/io/meshes/mesh_file.h"

namespace vinerow::io::collada_writer_test {
namespace {

/// Strip of squares along x, each of another grey.
TriangleMesh grey_strip(int squares) {
  TriangleMesh mesh;
  for (int i = 0; i < squares; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto x = static_cast<float>(i);
    const std::vector<Eigen::Vector3f> corners = {
        {x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0.1f}, {x, 1, 0.1f}};
    for (const Eigen::Vector3f& corner : corners) {
      mesh.vertices.push_back(corner);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
      mesh.colours.push_back(Eigen::Vector3f::Constant(x / static_cast<float>(squares)));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

std::filesystem::path temporary(const char* name) {
  return std::filesystem::path(::testing::TempDir()) / name;
}

TEST(ColladaWriter, KeepsAxesNormalsAndColours) {
  TriangleMesh mesh = grey_strip(2);
  mesh.triangles.push_back({0, 1, 99});  // a vertex that is missing
  Material material;
  material.colour = {1.0f, 0.5f, 0.25f};
  const auto file = temporary("grey.dae");
  write_collada(mesh, material, file);
  const MeshFile read = load_mesh(file, {.join_vertices = false});
  EXPECT_EQ(read.bounds().min(), mesh.bounds().min());
  EXPECT_EQ(read.bounds().max(), mesh.bounds().max());
  ASSERT_EQ(read.parts.size(), 2u);
  EXPECT_TRUE(read.parts[0].material.colour.isZero());
  // sRGB in 8 bits.
  EXPECT_TRUE(read.parts[1].material.colour.isApprox(0.5f * material.colour, 0.01f));
  EXPECT_EQ(read.parts[1].mesh->triangles.size(), 2u);
  EXPECT_EQ(read.parts[1].mesh->normals.at(0), Eigen::Vector3f(0, 0, 1));
}

TEST(ColladaWriter, LimitsTheNumberOfColours) {
  TriangleMesh mesh = grey_strip(600);
  for (std::size_t i = 0; i < mesh.colours.size(); ++i) {
    mesh.colours[i].x() = static_cast<float>(i / 4 % 7) / 7.0f;
  }
  const auto file = temporary("many.dae");
  write_collada(mesh, Material{}, file);
  const MeshFile read = load_mesh(file);
  EXPECT_LE(read.parts.size(), 256u);
  EXPECT_GT(read.parts.size(), 100u);
}

TEST(ColladaWriter, SaysWhatCannotBeWritten) {
  const auto error_of = [](const TriangleMesh& mesh, const char* file) -> std::string {
    try {
      write_collada(mesh, Material{}, file);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(error_of({}, "x.dae"), "mesh file 'x.dae': no triangles to write");
  TriangleMesh mesh = grey_strip(1);
  EXPECT_EQ(error_of(mesh, "/nowhere/x.dae"),
            "mesh file '/nowhere/x.dae' cannot be written: No such file or directory");
  mesh.vertices[2].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_of(mesh, "x.dae"),
            "mesh file 'x.dae': a vertex is not finite, it is not written");
}

}  // namespace
}  // namespace vinerow::io::collada_writer_test
