/// Distances, volumes and means against closed forms. HullContainment against brute force over
/// triangles: row_hull_test.cpp.

#include "worlds/mapping/hulls/hull_figures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::mapping::hull_figures_test {
namespace {

using Eigen::Vector3d;

TEST(HullFigures, DistanceToATriangleIsThatOfItsNearestPoint) {
  RandomStream random(1, "test", "triangles");
  const auto point = [&] {
    return Vector3d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                    random.uniform(-1.0, 1.0));
  };
  for (int n = 0; n < 200; ++n) {
    const Vector3d a = point(), b = point(), c = point(), p = point();
    const double distance_m = distance_to_triangle_m(p, a, b, c);
    // Nearest of a grid on the triangle, whose sides are shorter than 3.5 m.
    constexpr int kSteps = 120;
    double grid_m = 1e9;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
        grid_m = std::min(grid_m, (a + u * (b - a) + v * (c - a) - p).norm());
      }
    }
    EXPECT_LE(distance_m, grid_m + 1e-12);
    EXPECT_GE(distance_m, grid_m - 3.5 / kSteps);
  }
}

TEST(HullFigures, DistancesToFaceEdgesAndCorners) {
  const Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({1, 1, -2}, a, b, c), 2.0);
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({2, -3, 4}, a, b, c), 5.0);                 // edge ab
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({-3, 1, -4}, a, b, c), 5.0);                // edge ac
  EXPECT_NEAR(distance_to_triangle_m({2 + 0.6, 1.5 + 0.8, 0}, a, b, c), 1.0, 1e-12);  // edge bc
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({-1, -2, 2}, a, b, c), 3.0);                // corner a
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({7, 0, 4}, a, b, c), 5.0);                  // corner b
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({-3, 7, 0}, a, b, c), 5.0);                 // corner c
}

TEST(HullFigures, VolumeOfATetrahedronAnywhere) {
  TriangleMesh mesh;
  for (const Vector3d& p :
       {Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(0, 3, 0), Vector3d(0, 0, 4)}) {
    mesh.vertices.push_back((p + Vector3d(1000.0, -2000.0, 500.0)).cast<float>());
  }
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  EXPECT_NEAR(mesh_volume_m3(mesh), 2.0 * 3.0 * 4.0 / 6.0, 1e-9);
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  EXPECT_NEAR(mesh_volume_m3(mesh), -4.0, 1e-9);
  EXPECT_EQ(mesh_volume_m3({}), 0.0);
}

/// Box of 0.6 m from base to top.
HullChain box(double from_m, double to_m, double base_m, double top_m) {
  HullChain chain{HullDirections({-0.5 * kPi, 0.0, 0.5 * kPi, kPi}), {from_m, to_m}, {}};
  for (int j = 0; j < 2; ++j) {
    chain.h_m.insert(chain.h_m.end(), {-base_m, 0.3, top_m, 0.3});
  }
  return chain;
}

TEST(HullFigures, MeansWeighChainsByTheirLength) {
  const SectionMeans means = mean_sections({box(0.0, 1.0, 0.4, 1.6), box(2.0, 5.0, 0.8, 2.4)});
  EXPECT_NEAR(means.length_m, 4.0, 1e-12);
  EXPECT_NEAR(means.base_m, 0.25 * 0.4 + 0.75 * 0.8, 1e-12);
  EXPECT_NEAR(means.top_m, 0.25 * 1.6 + 0.75 * 2.4, 1e-12);
  EXPECT_NEAR(means.width_m, 0.6, 1e-12);
  EXPECT_EQ(mean_sections({}).length_m, 0.0);
}

TEST(HullFigures, ContainmentReachesTheToleranceAtFacesEndsAndCorners) {
  const std::vector<HullChain> chains{box(0.0, 1.0, 0.5, 2.0), box(2.0, 5.0, 0.5, 2.0)};
  const HullContainment containment(chains, 0.1);
  const double corner_m = 0.1 / std::sqrt(2.0);
  EXPECT_TRUE(containment.contains({0.5, 0.0, 1.0}));
  EXPECT_TRUE(containment.contains({0.5, 0.399, 1.0}));
  EXPECT_FALSE(containment.contains({0.5, 0.401, 1.0}));
  EXPECT_TRUE(containment.contains({0.5, 0.3 + 0.99 * corner_m, 2.0 + 0.99 * corner_m}));
  EXPECT_FALSE(containment.contains({0.5, 0.3 + 1.01 * corner_m, 2.0 + 1.01 * corner_m}));
  // Beyond ends, in the gap between the chains.
  EXPECT_TRUE(containment.contains({1.099, 0.0, 1.0}));
  EXPECT_FALSE(containment.contains({1.101, 0.0, 1.0}));
  EXPECT_TRUE(containment.contains({1.901, 0.0, 1.0}));
  EXPECT_FALSE(containment.contains({1.5, 0.0, 1.0}));
  EXPECT_FALSE(containment.contains({-0.101, 0.0, 1.0}));
  EXPECT_FALSE(containment.contains({5.101, 0.0, 1.0}));
  EXPECT_FALSE(containment.contains({0.5, std::nan(""), 1.0}));
  EXPECT_EQ(containment.count({{0.5f, 0.0f, 1.0f}, {1.5f, 0.0f, 1.0f}, {3.0f, 0.0f, 1.0f}}), 2);
}

TEST(HullFigures, ContainmentFollowsASectionThatWidens) {
  HullChain chain = box(0.0, 1.0, 0.5, 2.0);
  ASSERT_EQ(chain.sections(), 2);
  for (int k = 0; k < chain.directions.count(); ++k) chain.section(1)[k] += 0.3;
  // Half the width is 0.375 m after a quarter of the length.
  const std::vector<HullChain> chains{chain};
  const HullContainment containment(chains, 0.1);
  EXPECT_TRUE(containment.contains({0.25, 0.44, 1.0}));
  EXPECT_FALSE(containment.contains({0.25, 0.5, 1.0}));
}

}  // namespace
}  // namespace vinerow::mapping::hull_figures_test
