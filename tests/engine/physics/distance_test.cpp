/// Distance from boxes to triangles, against sampling and a second implementation.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/core/random.h"
#include "engine/physics/triangle_box.h"
#include "tests/engine/physics/small_worlds.h"

namespace vinerow::physics::distance_test {
namespace {

using Eigen::Vector3d;

Vector3d random_point(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// Alternating projections between the two convex sets (von Neumann), slow and simple: converges
/// to the distance from above.
double distance_by_projections(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                               const Vector3d& h) {
  const auto to_segment = [](const Vector3d& p, const Vector3d& s, const Vector3d& e) {
    const double t = std::clamp((p - s).dot(e - s) / (e - s).squaredNorm(), 0.0, 1.0);
    return Vector3d(s + t * (e - s));
  };
  const auto to_triangle = [&](const Vector3d& p) {
    const Vector3d n = (b - a).cross(c - a).normalized();
    const Vector3d foot = p - n * n.dot(p - a);
    const bool inside = (b - a).cross(foot - a).dot(n) >= 0 &&
                        (c - b).cross(foot - b).dot(n) >= 0 && (a - c).cross(foot - c).dot(n) >= 0;
    if (inside) return foot;
    Vector3d best = to_segment(p, a, b);
    for (const Vector3d& q : {to_segment(p, b, c), to_segment(p, c, a)}) {
      if ((q - p).norm() < (best - p).norm()) best = q;
    }
    return best;
  };
  Vector3d on_box = Vector3d::Zero(), on_triangle = a;
  for (int k = 0; k < 20'000; ++k) {
    on_box = on_triangle.cwiseMax(-h).cwiseMin(h);
    const Vector3d next = to_triangle(on_box);
    if ((next - on_triangle).norm() < 1e-13) break;
    on_triangle = next;
  }
  return (on_triangle - on_box).norm();
}

TEST(TriangleBox, AgreesWithAlternatingProjections) {
  RandomStream random(4, "", "triangles");
  int apart = 0, touching = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vector3d h(random.uniform(0.1, 1.0), random.uniform(0.1, 1.0), random.uniform(0.1, 1.0));
    const Vector3d centre = random_point(random, 2.5);
    const Vector3d a = centre + random_point(random, 1.5);
    const Vector3d b = centre + random_point(random, 1.5);
    const Vector3d c = centre + random_point(random, 1.5);
    const double exact = std::sqrt(triangle_box_distance2(a, b, c, h));
    const double slow = distance_by_projections(a, b, c, h);
    // The projections converge slowly where the sets nearly touch, and never from below.
    EXPECT_LE(exact, slow + 1e-9) << k;
    EXPECT_NEAR(exact, slow, 2e-3) << k;
    if (slow > 0.05) {
      EXPECT_NEAR(exact, slow, 1e-6) << k;
    }
    ++(exact > 0.0 ? apart : touching);
    EXPECT_LE(triangle_box_bound2(a, b, c, h), exact * exact + 1e-12);
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(touching, 200);
}

TEST(TriangleBox, KnowsTheSimpleCases) {
  const Vector3d h(1, 1, 1);
  const auto distance = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return std::sqrt(triangle_box_distance2(a, b, c, h));
  };
  // A large triangle over the face, one through the box without touching its edges, one inside.
  EXPECT_DOUBLE_EQ(distance({-9, -9, 3}, {9, -9, 3}, {0, 9, 3}), 2.0);
  EXPECT_DOUBLE_EQ(distance({-9, -9, 0.5}, {9, -9, 0.5}, {0, 9, 0.5}), 0.0);
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}), 0.0);
  // Corner over a tilted face: plane x + y + z = 6, distance (6 - 3) / sqrt(3).
  EXPECT_NEAR(distance({12, -3, -3}, {-3, 12, -3}, {-3, -3, 12}), 3.0 / std::sqrt(3.0), 1e-12);
  // Edge against edge, crossing at right angles.
  EXPECT_NEAR(distance({3, 3, -5}, {3, 3, 5}, {9, 9, 0}), std::sqrt(8.0), 1e-12);
  // Degenerate triangles are segments and points.
  EXPECT_DOUBLE_EQ(distance({3, 0, 0}, {3, 0, 0}, {3, 0, 0}), 2.0);
  EXPECT_DOUBLE_EQ(distance({3, -5, 0}, {3, 5, 0}, {3, 0, 0}), 2.0);
}

TEST(Distance, TreeSearchEqualsBruteForceOverAllTriangles) {
  // Scattered leaves: 20 instances of one clump of 300 triangles, turned and moved.
  RandomStream random(5, "", "leaves");
  auto clump = std::make_shared<TriangleMesh>();
  for (std::uint32_t t = 0; t < 300; ++t) {
    const Vector3d centre = random_point(random, 1.0);
    for (int k = 0; k < 3; ++k) {
      clump->vertices.push_back((centre + random_point(random, 0.1)).cast<float>());
    }
    clump->triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  WorldModel model;
  for (int k = 0; k < 20; ++k) {
    MeshInstance instance =
        test::make_instance("leaves", clump, random_point(random, 8.0), SurfaceClass::kCanopy);
    instance.X_WM.q = quaternion_from_rpy({random.normal(), random.normal(), random.normal()});
    model.meshes.push_back(instance);
  }
  const PhysicsWorld world({}, model);
  int overlapping = 0;
  for (int k = 0; k < 200; ++k) {
    const Vector3d h(random.uniform(0.1, 0.8), random.uniform(0.1, 0.8), random.uniform(0.1, 0.8));
    Pose X_WBox{quaternion_from_rpy({random.normal(), random.normal(), random.normal()}),
                random_point(random, 9.0)};
    double best2 = 3.0 * 3.0;
    for (const MeshInstance& instance : model.meshes) {
      const Pose X_OM = X_WBox.inverse() * instance.X_WM;
      for (const auto& [i, j, l] : clump->triangles) {
        best2 =
            std::min(best2, triangle_box_distance2(X_OM * clump->vertices[i].cast<double>(),
                                                   X_OM * clump->vertices[j].cast<double>(),
                                                   X_OM * clump->vertices[l].cast<double>(), h));
      }
    }
    const double found = world.scene().distance_to_box_m(X_WBox, h, 3.0);
    EXPECT_NEAR(found, std::sqrt(best2), 1e-9) << k;
    overlapping += found == 0.0;
  }
  EXPECT_GT(overlapping, 5);
}

TEST(Distance, MaskAndReachAreKept) {
  WorldModel model;
  model.terrain = test::make_flat();
  model.meshes = {test::make_instance("canopy", test::make_box_mesh({0.5f, 5.0f, 0.5f}), {3, 0, 1},
                                      SurfaceClass::kCanopy),
                  test::make_instance("wire", test::make_box_mesh({0.01f, 5.0f, 0.01f}), {1, 0, 1},
                                      SurfaceClass::kWire)};
  const PhysicsWorld world({}, model);
  const SceneQuery& scene = world.scene();
  const Pose X_WBox{Eigen::Quaterniond::Identity(), {0, 0, 1}};
  const Vector3d h(0.4, 0.3, 0.2);
  EXPECT_NEAR(scene.distance_to_box_m(X_WBox, h, 10.0), 3.0 - 0.5 - 0.4, 1e-6);
  EXPECT_EQ(scene.distance_to_box_m(X_WBox, h, 2.0), 2.0);
  EXPECT_NEAR(scene.distance_to_box_m(X_WBox, h, 10.0, mask_of(SurfaceClass::kWire)),
              1.0 - 0.01 - 0.4, 1e-6);
  EXPECT_EQ(scene.distance_to_box_m(X_WBox, h, 10.0, mask_of(SurfaceClass::kPost)), 10.0);
  EXPECT_NEAR(scene.distance_to_box_m(X_WBox, h, 10.0, mask_of(SurfaceClass::kTerrain)), 0.8, 1e-9);
  EXPECT_EQ(scene.distance_to_box_m({X_WBox.q, {3, 0, 1.6}}, h, 10.0), 0.0);
}

}  // namespace
}  // namespace vinerow::physics::distance_test
