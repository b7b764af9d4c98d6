#include "engine/api/map.h"
#include "worlds/mapping/photogrammetry/canopy_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/worlds/mapping/photogrammetry/cloud_scene.h"

namespace vinerow::mapping::canopy_volume_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<CanopyTriangle> triangles_of(const TriangleMesh& mesh, const Pose& X_WM = {}) {
  std::vector<CanopyTriangle> triangles;
  for (const auto& t : mesh.triangles) {
    CanopyTriangle& triangle = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = X_WM * mesh.vertices[t[k]].cast<double>();
  }
  return triangles;
}

std::vector<CanopyTriangle> box(const Vector3d& low, const Vector3d& high, const Pose& X_WM = {}) {
  return triangles_of(test::box_mesh(low, high), X_WM);
}

std::vector<CanopyTriangle> joined(std::vector<CanopyTriangle> a,
                                   const std::vector<CanopyTriangle>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Prism with `n` sides around the x axis.
std::vector<CanopyTriangle> prism(int n, double radius_m, double length_m, const Vector3d& at) {
  std::vector<CanopyTriangle> triangles;
  const auto corner = [&](int k, double x) -> Vector3d {
    const double angle = 2.0 * std::numbers::pi * k / n;
    return at + Vector3d(x, radius_m * std::cos(angle), radius_m * std::sin(angle));
  };
  for (int k = 0; k < n; ++k) {
    const Vector3d a = corner(k, 0.0), b = corner(k + 1, 0.0), c = corner(k, length_m),
                   d = corner(k + 1, length_m);
    triangles.push_back({a, b, d});
    triangles.push_back({a, d, c});
    triangles.push_back({at, b, a});
    triangles.push_back({at + Vector3d(length_m, 0, 0), c, d});
  }
  return triangles;
}

const Vector2d kEast(1.0, 0.0);

TEST(CanopyVolume, OfABoxIsItsSidesProduct) {
  // The grid ends where the box does: 1 cm in 30 m, 1.5 m.
  EXPECT_NEAR(enclosed_volume_m3(box({3, 4, 5}, {33, 4.6, 6.5}), kEast, 0.02), 27.0, 1e-4);
  const Pose turned{quaternion_from_rpy({0.3, -0.2, 1.1}), {100.0, -50.0, 7.0}};
  EXPECT_NEAR(enclosed_volume_m3(box({0, 0, 0}, {3, 2, 1}, turned), kEast, 0.01), 6.0, 0.006);
  EXPECT_NEAR(enclosed_volume_m3(box({0, 0, 0}, {3, 2, 1}, turned), Vector2d(0.6, 0.8), 0.01), 6.0,
              0.006);
}

TEST(CanopyVolume, OfACylinderIsThatOfItsPrism) {
  const int n = 64;
  const double r = 0.4, length = 12.0;
  const double expected = 0.5 * n * r * r * std::sin(2.0 * std::numbers::pi / n) * length;
  EXPECT_NEAR(enclosed_volume_m3(prism(n, r, length, {1, 2, 3}), kEast, 0.02), expected,
              0.002 * expected);
  EXPECT_NEAR(enclosed_volume_m3(prism(n, r, length, {1, 2, 3}), Vector2d(0.8, -0.6), 0.02),
              expected, 0.002 * expected);
}

TEST(CanopyVolume, CountsWhatTwoEncloseOnce) {
  const auto one = box({0, 0, 0}, {4, 2, 2}), other = box({3, 1, 1}, {6, 3, 3});
  // 16 + 12 - 1 * 1 * 1
  EXPECT_NEAR(enclosed_volume_m3(joined(one, other), kEast, 0.02), 27.0, 0.01);
  EXPECT_NEAR(enclosed_volume_m3(joined(one, box({1, 0.5, 0.5}, {2, 1, 1})), kEast, 0.02), 16.0,
              0.01);
  EXPECT_NEAR(enclosed_volume_m3(joined(one, one), kEast, 0.02), 16.0, 0.01);
}

TEST(CanopyVolume, OfAnOpenMeshIsNothing) {
  auto open = box({0, 0, 0}, {4, 2, 2});
  // Without the two triangles that look north.
  std::erase_if(open, [](const CanopyTriangle& t) {
    return t[0].y() == 2.0 && t[1].y() == 2.0 && t[2].y() == 2.0;
  });
  ASSERT_EQ(open.size(), 10u);
  EXPECT_EQ(enclosed_volume_m3(open, kEast, 0.02), 0.0);
  EXPECT_EQ(enclosed_volume_m3({}, kEast, 0.02), 0.0);
}

TEST(CanopyByRow, GivesEachPieceToTheNearestRow) {
  WorldModel world = test::level_world(
      50.0, {test::box({-5, -0.3, 0.5}, {5, 0.3, 2}), test::box({-5, 2.2, 0.5}, {5, 2.8, 2}),
             test::box({-5, 2.2, 0.5}, {5, 2.8, 2}, SurfaceClass::kPost),
             test::box({-5, 12, 0.5}, {5, 13, 4})});
  // Both rows in one mesh as well.
  TriangleMesh both = test::box_mesh({6, -0.3, 0.5}, {7, 0.3, 2});
  const TriangleMesh more = test::box_mesh({6, 2.2, 0.5}, {7, 2.8, 2});
  for (const auto& v : more.vertices) both.vertices.push_back(v);
  for (const auto& t : more.triangles) both.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  world.meshes.push_back(test::box({0, 0, 0}, {1, 1, 1}));
  world.meshes.back().mesh = std::make_shared<TriangleMesh>(both);
  for (const double y : {0.0, 2.5}) {
    PlantRow row;
    row.line_W = {{-10, y, 0}, {10, y, 0}};
    world.rows->rows.push_back(row);
  }
  const auto canopy = canopy_by_row(world);
  ASSERT_EQ(canopy.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(canopy[k].size(), 24u);
    EXPECT_NEAR(enclosed_volume_m3(canopy[k], kEast, 0.02), 11.0 * 0.6 * 1.5, 0.01);
    for (const CanopyTriangle& triangle : canopy[k]) {
      for (const Vector3d& p : triangle) EXPECT_NEAR(p.y(), 2.5 * static_cast<double>(k), 0.31);
    }
  }
}

}  // namespace
}  // namespace vinerow::mapping::canopy_volume_test
