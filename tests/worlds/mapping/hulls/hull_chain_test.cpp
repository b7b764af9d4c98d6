/// Sections and chains against regular polygons, frustums and Pappus' theorem.

#include "worlds/mapping/hulls/hull_chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "worlds/mapping/hulls/hull_figures.h"

namespace vinerow::mapping::hull_chain_test {
namespace {

HullDirections regular(int corners) {
  std::vector<double> angles;
  for (int k = 0; k < corners; ++k) angles.push_back(-kPi + 2.0 * kPi * k / corners);
  return HullDirections(std::move(angles));
}

double level(double, double) {
  return 0.0;
}

TEST(HullChain, RegularPolygonsHaveTheirSidesAreaAndCorners) {
  for (const int n : {3, 5, 8, 16}) {
    SCOPED_TRACE(n);
    const HullDirections directions = regular(n);
    const double inner_m = 0.7, half_rad = kPi / n;
    const std::vector<double> h(static_cast<std::size_t>(n), inner_m);
    for (int k = 0; k < n; ++k) {
      EXPECT_NEAR(directions.side_m(h.data(), k), 2.0 * inner_m * std::tan(half_rad), 1e-12);
      const Eigen::Vector2d corner = directions.corner(h.data(), k);
      EXPECT_NEAR(corner.norm(), inner_m / std::cos(half_rad), 1e-12);
      EXPECT_NEAR(
          std::remainder(std::atan2(corner.y(), corner.x()) - directions.angle_rad(k) - half_rad,
                         2.0 * kPi),
          0.0, 1e-12);
    }
    EXPECT_NEAR(directions.area_m2(h.data()), n * inner_m * inner_m * std::tan(half_rad), 1e-12);
  }
}

TEST(HullChain, SidesGrowAndShrinkAtTheStatedRates) {
  const HullDirections directions({-3.0, -1.2, 0.1, 1.0, 2.4});
  std::vector<double> h = {0.5, 0.6, 0.7, 0.65, 0.55};
  const double step_m = 1e-3;
  for (int k = 0; k < 5; ++k) {
    const double own_m = directions.side_m(h.data(), k);
    const double before_m = directions.side_m(h.data(), directions.before(k));
    h[static_cast<std::size_t>(k)] += step_m;
    EXPECT_NEAR((own_m - directions.side_m(h.data(), k)) / step_m, directions.shrink(k), 1e-9);
    EXPECT_NEAR((directions.side_m(h.data(), directions.before(k)) - before_m) / step_m,
                directions.inverse_sin(directions.before(k)), 1e-9);
    h[static_cast<std::size_t>(k)] -= step_m;
  }
}

TEST(HullChain, RepairMovesASideBeyondItsNeighboursInToTheirCorner) {
  const HullDirections directions = regular(8);
  std::vector<double> h(8, 1.0);
  h[2] = 2.0;  // its neighbours meet sqrt(2) from the middle
  directions.repair(h.data(), 0.005);
  EXPECT_NEAR(directions.side_m(h.data(), 2), 0.005, 1e-9);
  // A side of 5 mm at a corner of 90 degrees is 2.5 mm inside of it.
  EXPECT_NEAR(h[2], std::sqrt(2.0) - 0.0025, 1e-9);
  for (const int k : {0, 1, 3, 4, 5, 6, 7}) EXPECT_EQ(h[static_cast<std::size_t>(k)], 1.0);
}

TEST(HullChain, RepairMakesASectionOfNothing) {
  const HullDirections directions = regular(8);
  std::vector<double> h(8, 0.3);
  h[0] = -0.5;  // opposite sides have passed each other
  h[4] = -0.5;
  directions.repair(h.data(), 0.005);
  for (int k = 0; k < 8; ++k) EXPECT_GE(directions.side_m(h.data(), k), 0.005 - 1e-9) << k;
}

/// Octagon of inner radius a at s = 0, and b at s = length.
HullChain frustum(double a, double b, double length_m) {
  HullChain chain{regular(8), {0.0, length_m}, {}};
  chain.h_m.assign(8, a);
  chain.h_m.resize(16, b);
  return chain;
}

TEST(HullChain, VolumeOfAFrustum) {
  const double per_m2 = 8.0 * std::tan(kPi / 8.0);  // area over the square of the inner radius
  const HullChain chain = frustum(0.5, 0.2, 6.0);
  const double wanted_m3 = per_m2 * 6.0 / 3.0 * (0.25 + 0.1 + 0.04);
  EXPECT_NEAR(volume_m3(chain), wanted_m3, 1e-12);
  const RowCurve row({Eigen::Vector2d(0, 0), Eigen::Vector2d(6, 0)});
  const TriangleMesh mesh = make_chain_mesh(chain, row, level);
  EXPECT_NEAR(mesh_volume_m3(mesh), wanted_m3, 1e-6);
  EXPECT_EQ(mesh.vertices.size(), 16u);
  EXPECT_EQ(mesh.triangles.size(), 2u * 8u + 2u * 6u);
}

TEST(HullChain, MeshFollowsLineAndGround) {
  // A row to the north on a slope: y of the section is to the west, z above the ground on the line.
  const HullChain chain = frustum(0.5, 0.5, 4.0);
  const RowCurve row({Eigen::Vector2d(10, 20), Eigen::Vector2d(10, 24)});
  const TriangleMesh mesh =
      make_chain_mesh(chain, row, [](double x, double y) { return 100.0 + x + 2.0 * y; });
  for (std::size_t n = 0; n < 16; ++n) {
    const Eigen::Vector2d corner =
        chain.directions.corner(chain.section(n < 8 ? 0 : 1), static_cast<int>(n % 8));
    const Eigen::Vector3f wanted = Eigen::Vector3d(10.0 - corner.x(), n < 8 ? 20.0 : 24.0,
                                                   (n < 8 ? 150.0 : 158.0) + corner.y())
                                       .cast<float>();
    EXPECT_LT((mesh.vertices[n] - wanted).norm(), 1e-5) << n;
  }
}

TEST(HullChain, BytesAreThoseOfVerticesAndFaces) {
  // 12 bytes for a vertex, 13 for a triangle.
  EXPECT_EQ(ply_bytes(8, 2), 12 * 16 + 13 * 28);
  EXPECT_EQ(ply_bytes(8, 3) - ply_bytes(8, 2), 12 * 8 + 13 * 16);
  EXPECT_EQ(ply_bytes(8, 1), 0);
}

}  // namespace
}  // namespace vinerow::mapping::hull_chain_test
