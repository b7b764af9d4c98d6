#include "engine/physics/winding.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vinerow::physics::winding_test {
namespace {

/// The cube from -1 to 1. Its first two triangles are its lower side.
TriangleMesh make_cube() {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back(k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f, k & 4 ? 1.0f : -1.0f);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(Winding, OfAClosedMeshIsOneInsideAndNoneOutside) {
  TriangleMesh cube = make_cube();
  EXPECT_NEAR(calc_winding(cube, {0, 0, 0}), 1.0, 1e-12);
  EXPECT_NEAR(calc_winding(cube, {0.9, -0.95, 0.99}), 1.0, 1e-12);
  EXPECT_NEAR(calc_winding(cube, {0.3, 0.2, 1.01}), 0.0, 1e-12);
  EXPECT_NEAR(calc_winding(cube, {40, 2, -7}), 0.0, 1e-12);
  for (auto& triangle : cube.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_NEAR(calc_winding(cube, {0, 0, 0}), -1.0, 1e-12);
}

TEST(Winding, OfAnOpenMeshLacksTheShareOfItsOpening) {
  // Each side of a cube is a sixth of the view from its middle.
  TriangleMesh cube = make_cube();
  cube.triangles.erase(cube.triangles.begin(), cube.triangles.begin() + 2);
  EXPECT_NEAR(calc_winding(cube, {0, 0, 0}), 5.0 / 6.0, 1e-12);
}

TEST(Winding, OfAShellIsNoneInItsHollow) {
  TriangleMesh shell = make_cube();
  const auto outer = static_cast<std::uint32_t>(shell.vertices.size());
  const TriangleMesh cube = make_cube();
  for (const auto& v : cube.vertices) shell.vertices.push_back(0.8f * v);
  for (const auto& [a, b, c] : cube.triangles) {
    shell.triangles.push_back({outer + b, outer + a, outer + c});
  }
  EXPECT_NEAR(calc_winding(shell, {0, 0, 0}), 0.0, 1e-12);
  EXPECT_NEAR(calc_winding(shell, {0.9, 0, 0}), 1.0, 1e-12);
}

}  // namespace
}  // namespace vinerow::physics::winding_test
