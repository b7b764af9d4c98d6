#include "engine/render/mesh_preparation.h"

#include <gtest/gtest.h>

#include <set>

#include "engine/render/builtin_textures.h"
#include "tests/engine/render/test_scenes.h"

namespace vinerow::render::mesh_preparation_test {
namespace {

TEST(PrepareMesh, ABoxKeepsItsSharpEdges) {
  const PreparedMesh box = prepare_mesh(*test::make_box({1, 2, 3}), CardKind::kNone);
  EXPECT_TRUE(box.closed);
  EXPECT_EQ(box.indices.size(), 36u);
  EXPECT_EQ(box.vertices.size(), 24u);  // 8 corners with 3 normals each
  for (const GpuVertex& v : box.vertices) {
    EXPECT_EQ(std::abs(v.normal[0]) + std::abs(v.normal[1]) + std::abs(v.normal[2]), 127);
  }
}

TEST(PrepareMesh, ACylinderIsRoundAroundAndSharpAtItsRim) {
  TriangleMesh tube;
  constexpr std::uint32_t kSides = 24;  // 15 deg between faces, below the crease angle
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const float a = 2.0f * 3.14159265f * static_cast<float>(i) / kSides;
    for (const float z : {0.0f, 1.0f}) tube.vertices.emplace_back(std::cos(a), std::sin(a), z);
  }
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t a = 2 * i;
    const std::uint32_t b = 2 * ((i + 1) % kSides);
    tube.triangles.push_back({a, b, b + 1});
    tube.triangles.push_back({a, b + 1, a + 1});
  }
  const PreparedMesh prepared = prepare_mesh(tube, CardKind::kNone);
  EXPECT_FALSE(prepared.closed);
  for (const GpuVertex& v : prepared.vertices) {
    // Smooth: the normal points along the radius. 3 units for 8 bits and the uneven triangles.
    EXPECT_NEAR(v.normal[0], 127 * v.position[0], 12);
    EXPECT_NEAR(v.normal[1], 127 * v.position[1], 12);
    EXPECT_EQ(v.normal[2], 0);
  }
}

TEST(PrepareMesh, InsideOutOrOpenMeshesAreTwoSided) {
  TriangleMesh box = *test::make_box({1, 1, 1});
  for (auto& t : box.triangles) std::swap(t[1], t[2]);
  EXPECT_FALSE(prepare_mesh(box, CardKind::kNone).closed);
  box = *test::make_box({1, 1, 1});
  box.triangles.pop_back();
  EXPECT_FALSE(prepare_mesh(box, CardKind::kNone).closed);
}

TEST(PrepareMesh, CardsGetPicturesThatSuitTheirSize) {
  TriangleMesh cards;
  const auto add = [&](float edge) {
    const auto first = static_cast<std::uint32_t>(cards.vertices.size());
    for (const auto& [u, v] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
      cards.vertices.emplace_back(u * edge, 0.0f, v * edge);
      cards.uvs.emplace_back(u, v);
    }
    cards.triangles.push_back({first, first + 1, first + 2});
    cards.triangles.push_back({first, first + 2, first + 3});
  };
  add(0.13f);
  add(0.4f);
  add(0.9f);
  const PreparedMesh prepared = prepare_mesh(cards, CardKind::kVine);
  ASSERT_EQ(prepared.vertices.size(), 12u);
  const auto layer = [&](int card) { return int{prepared.vertices[4 * card].colour[3]}; };
  EXPECT_LT(layer(0), kLeafSpray);
  EXPECT_GE(layer(1), kLeafSpray);
  EXPECT_LT(layer(1), kLeafClump);
  EXPECT_GE(layer(2), kLeafClump);
  EXPECT_LT(layer(2), kLeafLayersPerKind);
  EXPECT_GE(int{prepare_mesh(cards, CardKind::kTree).vertices[0].colour[3]}, kLeafLayersPerKind);
  for (int card = 0; card < 3; ++card) {
    for (int k = 1; k < 4; ++k) EXPECT_EQ(prepared.vertices[4 * card + k].colour[3], layer(card));
  }
}

TEST(PrepareMesh, TrianglesWithIndicesOutOfRangeAreDropped) {
  TriangleMesh mesh = *test::make_box({1, 1, 1});
  mesh.triangles.push_back({0, 1, 99});
  EXPECT_EQ(prepare_mesh(mesh, CardKind::kNone).indices.size(), 36u);
}

}  // namespace
}  // namespace vinerow::render::mesh_preparation_test
