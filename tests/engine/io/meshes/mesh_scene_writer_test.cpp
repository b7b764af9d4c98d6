#include "engine/io/meshes/mesh_scene_writer.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>

#include "engine/core/error.h"
#include "engine/io/meshes/mesh_file.h"
#include "engine/io/meshes/mesh_writer.h"

namespace vinerow::io::mesh_scene_writer_test {
namespace {

/// A wedge of 1 x 2 x 3 m from `corner` on: its extents distinguish the axes.
TriangleMesh wedge(const Eigen::Vector3f& corner) {
  TriangleMesh mesh;
  for (const Eigen::Vector3f& v : {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 0, 0),
                                   Eigen::Vector3f(0, 2, 0), Eigen::Vector3f(0, 0, 3)}) {
    mesh.vertices.push_back(corner + v);
  }
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

class MeshSceneWriterTest : public ::testing::Test {
 protected:
  MeshSceneWriterTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / "vinerow_mesh_scene_test" / test->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~MeshSceneWriterTest() override { std::filesystem::remove_all(folder_); }

  /// What assimp reads is what was given, to `tolerance_m`.
  void expect_read_back(const std::filesystem::path& file, float tolerance_m) const {
    MeshFileOptions options;
    options.join_vertices = false;
    const MeshFile content = load_mesh(file, options);
    ASSERT_EQ(content.parts.size(), meshes_.size());
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      const TriangleMesh &wanted = *meshes_[i].mesh, &back = *content.parts[i].mesh;
      EXPECT_EQ(content.parts[i].name, meshes_[i].name);
      ASSERT_EQ(back.triangles.size(), wanted.triangles.size());
      for (std::size_t t = 0; t < wanted.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector3f off =
              back.vertices[back.triangles[t][k]] - wanted.vertices[wanted.triangles[t][k]];
          EXPECT_LE(off.cwiseAbs().maxCoeff(), tolerance_m);
        }
      }
    }
  }

  std::string error_of(const auto& write) const {
    try {
      write();
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "no error";
  }

  TriangleMesh near_ = wedge({0.125f, -3.5f, 0.25f}), far_ = wedge({812.0625f, 433.5f, -17.75f});
  std::vector<NamedMesh> meshes_{{"row_00_hull_00", &near_}, {"row_07_hull_02", &far_}};
  std::filesystem::path folder_;
};

TEST_F(MeshSceneWriterTest, GlbIsReadBackWithItsAxesTurnedAsTheRootSays) {
  const auto file = folder_ / "m.glb";
  write_glb(meshes_, file, canopy_material());
  // The root's rotation is of 15 digits, then of a float matrix: 1e-7 of the distance.
  expect_read_back(file, 2e-4f);
  const MeshFile content = load_mesh(file);
  const Eigen::Vector3f colour = content.parts[0].material.colour;
  EXPECT_GT(colour.y(), 2.0f * colour.x());
  EXPECT_GT(colour.y(), 2.0f * colour.z());
}

TEST_F(MeshSceneWriterTest, ObjIsReadBackToATenthOfAMillimetre) {
  const auto file = folder_ / "m.obj";
  write_obj(meshes_, file);
  expect_read_back(file, 1e-4f);
}

TEST_F(MeshSceneWriterTest, OnePlyHoldsAllMeshes) {
  const auto file = folder_ / "m.ply";
  write_ply(join_meshes(meshes_), file);
  MeshFileOptions options;
  options.join_vertices = false;
  const MeshFile content = load_mesh(file, options);
  ASSERT_EQ(content.parts.size(), 1u);
  const TriangleMesh& mesh = *content.parts[0].mesh;
  ASSERT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.vertices[5], far_.vertices[1]);
  ASSERT_EQ(mesh.triangles.size(), 8u);
  EXPECT_EQ(mesh.triangles[4], (std::array<std::uint32_t, 3>{4, 6, 5}));
}

TEST_F(MeshSceneWriterTest, ManyVerticesNeedLongerIndices) {
  // 65,536 vertices: one more than 16 bits can index without the reserved number.
  TriangleMesh strip;
  for (int i = 0; i < 65'536; ++i) {
    strip.vertices.emplace_back(0.125f * static_cast<float>(i / 2), static_cast<float>(i % 2),
                                0.0f);
  }
  for (std::uint32_t i = 0; i + 2 < 65'536; ++i) strip.triangles.push_back({i, i + 1, i + 2});
  const auto file = folder_ / "m.glb";
  write_glb(std::vector<NamedMesh>{{"strip", &strip}}, file, canopy_material());
  const MeshFile content = load_mesh(file);
  ASSERT_EQ(content.parts.size(), 1u);
  EXPECT_EQ(content.parts[0].mesh->triangles.size(), strip.triangles.size());
  EXPECT_NEAR(content.bounds().sizes().x(), 0.125 * 32'767, 1e-2);
}

TEST_F(MeshSceneWriterTest, TheSameMeshesGiveTheSameBytes) {
  const auto bytes_of = [&](const char* name) {
    write_glb(meshes_, folder_ / name, canopy_material());
    std::ifstream stream(folder_ / name, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  };
  EXPECT_EQ(bytes_of("a.glb"), bytes_of("b.glb"));
}

TEST_F(MeshSceneWriterTest, WhatCannotBeWrittenIsSaid) {
  EXPECT_EQ(error_of([&] { write_obj({}, "x.obj"); }),
            "mesh file 'x.obj': no mesh has triangles to write");
  far_.vertices[2].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_of([&] { write_glb(meshes_, "x.glb", canopy_material()); }),
            "mesh file 'x.glb': mesh 'row_07_hull_02' has a vertex that is not finite, it is not "
            "written");
  far_.vertices[2].y() = 0.0f;
  EXPECT_EQ(error_of([&] { write_glb(meshes_, "/nowhere/x.glb", canopy_material()); }),
            "mesh file '/nowhere/x.glb' cannot be written: No such file or directory");
}

}  // namespace
}  // namespace vinerow::io::mesh_scene_writer_test
