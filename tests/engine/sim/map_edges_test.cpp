#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/sim/map_edges.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::map_edges_test {
namespace {

double total_length_m(const LineList& lines) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < lines.points_W.size(); i += 2) {
    sum += (lines.points_W[i + 1] - lines.points_W[i]).norm();
  }
  return sum;
}

/// Box from the origin with faces of two triangles each.
TriangleMesh box(float a, float b, float c) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) ? a : 0.0f, (i & 2) ? b : 0.0f, (i & 4) ? c : 0.0f);
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

RowMap map_of(const TriangleMesh& mesh) {
  RowMap map;
  map.meshes = {{0, mesh}};
  return map;
}

TEST(MapEdges, ABoxHasItsTwelveEdgesAndNoDiagonals) {
  const LineList lines = map_edges(map_of(box(3.0f, 2.0f, 0.5f)));
  ASSERT_EQ(lines.points_W.size(), 24u);
  EXPECT_NEAR(total_length_m(lines), 4 * (3.0 + 2.0 + 0.5), 1e-6);
}

TEST(MapEdges, VerticesOfTheirOwnChangeNothing) {
  const TriangleMesh shared = box(3.0f, 2.0f, 0.5f);
  TriangleMesh soup;
  for (const auto& triangle : shared.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t corner : triangle) soup.vertices.push_back(shared.vertices[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(map_edges(map_of(soup)).points_W, map_edges(map_of(shared)).points_W);
}

// Two sheets that meet in their longest edge: flat it is a diagonal, as a roof it is the ridge.
TEST(MapEdges, ARidgeIsNoDiagonal) {
  const auto edges_at = [](double bend_rad) {
    TriangleMesh sheets;
    const auto c = static_cast<float>(std::cos(0.5 * bend_rad));
    const auto s = static_cast<float>(std::sin(0.5 * bend_rad));
    sheets.vertices = {{0, 0, 0}, {2, 0, 0}, {1, c, -s}, {1, -c, -s}};
    sheets.triangles = {{0, 1, 2}, {1, 0, 3}};
    return map_edges(map_of(sheets)).points_W.size() / 2;
  };
  EXPECT_EQ(edges_at(0.0), 4u);
  EXPECT_EQ(edges_at(0.6), 4u);
  EXPECT_EQ(edges_at(1.0), 5u);
}

TEST(MapEdges, ARegularTetrahedronKeepsAllSix) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  EXPECT_EQ(map_edges(map_of(mesh)).points_W.size(), 12u);
}

TEST(MapEdges, OfEveryRowAndOfNoneNothing) {
  EXPECT_TRUE(map_edges(RowMap{}).points_W.empty());
  RowMap map = map_of(box(3.0f, 2.0f, 0.5f));
  map.meshes.push_back({1, box(1.0f, 2.0f, 4.0f)});
  EXPECT_NEAR(total_length_m(map_edges(map)), 4 * (5.5 + 7.0), 1e-6);
}

}  // namespace
}  // namespace vinerow::map_edges_test
