#include "engine/io/meshes/mesh_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/io/meshes/mesh_file.h"

namespace vinerow::io::mesh_writer_test {
namespace {

TriangleMesh random_mesh(int vertices, RandomStream& random) {
  TriangleMesh mesh;
  const auto number = [&] { return static_cast<float>(random.uniform(-200.0, 200.0)); };
  for (int i = 0; i < vertices; ++i) {
    mesh.vertices.emplace_back(number(), number(), number());
    mesh.normals.push_back(Eigen::Vector3f(number(), number(), number()).normalized());
    mesh.uvs.emplace_back(number(), number());
    mesh.colours.emplace_back(std::abs(number()), std::abs(number()), std::abs(number()));
    if (i >= 2) {
      const auto k = static_cast<std::uint32_t>(i);
      mesh.triangles.push_back({k - 2, k - 1, k});
    }
  }
  if (vertices % 2 == 0) mesh.things = {0, 1};
  if (vertices % 3 == 0) mesh.normals.clear();
  if (vertices % 4 == 0) mesh.colours.clear();
  if (vertices % 5 == 0) mesh.uvs.clear();
  return mesh;
}

TEST(MeshWriter, WhatIsReadBackIsEqualToTheBit) {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_mesh_writer_test";
  std::filesystem::create_directories(folder);
  MeshFileOptions options;
  options.join_vertices = false;
  RandomStream random(1, "test", "mesh");
  // 600 files: one in 256 begins its data with the byte that assimp mistakes.
  for (int i = 0; i < 600; ++i) {
    const TriangleMesh mesh = random_mesh(3 + i % 7, random);
    const auto file = folder / "m.ply";
    write_ply(mesh, file);
    const MeshFile content = load_mesh(file, options);
    ASSERT_EQ(content.parts.size(), 1u);
    const TriangleMesh& back = *content.parts[0].mesh;
    ASSERT_EQ(back.vertices, mesh.vertices) << i;
    ASSERT_EQ(back.normals, mesh.normals) << i;
    ASSERT_EQ(back.uvs, mesh.uvs) << i;
    ASSERT_EQ(back.colours, mesh.colours) << i;
    ASSERT_EQ(back.triangles, mesh.triangles) << i;
    const std::optional<TriangleMesh> intact = read_intact_ply(file);
    ASSERT_TRUE(intact);
    ASSERT_EQ(intact->vertices, mesh.vertices) << i;
    ASSERT_EQ(intact->normals, mesh.normals) << i;
    ASSERT_EQ(intact->uvs, mesh.uvs) << i;
    ASSERT_EQ(intact->colours, mesh.colours) << i;
    ASSERT_EQ(intact->triangles, mesh.triangles) << i;
    ASSERT_EQ(intact->things, mesh.things) << i;
  }
  std::filesystem::remove_all(folder);
}

TEST(MeshWriter, DamageIsSeen) {
  const auto file = std::filesystem::temp_directory_path() / "vinerow_mesh_writer_damage.ply";
  RandomStream random(1, "test", "mesh");
  const TriangleMesh mesh = random_mesh(10, random);
  EXPECT_FALSE(read_intact_ply("/nowhere/x.ply"));
  write_ply(mesh, file);
  EXPECT_TRUE(read_intact_ply(file));
  const auto size = std::filesystem::file_size(file);
  for (const std::uintmax_t cut : {size - 1, size / 2, std::uintmax_t{70}, std::uintmax_t{3}}) {
    write_ply(mesh, file);
    std::filesystem::resize_file(file, cut);
    EXPECT_FALSE(read_intact_ply(file)) << cut;
  }
  write_ply(mesh, file);
  {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(-20, std::ios::end);
    stream.put('\x77');
  }
  EXPECT_FALSE(read_intact_ply(file));
  // A whole file of another writer.
  std::ofstream(file) << "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n";
  EXPECT_FALSE(read_intact_ply(file));
  std::filesystem::remove(file);
}

TEST(MeshWriter, RefusesAFolderThatIsNotThere) {
  try {
    write_ply(TriangleMesh{}, "/nowhere/x.ply");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_STREQ(e.what(),
                 "mesh file '/nowhere/x.ply' cannot be written: No such file or directory");
  }
}

}  // namespace
}  // namespace vinerow::io::mesh_writer_test
