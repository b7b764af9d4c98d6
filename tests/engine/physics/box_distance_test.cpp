/// Distance between boxes, against closed forms, projections and sampling.

#include "engine/physics/box_distance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/support/no_alloc.h"

namespace vinerow::physics::box_distance_test {
namespace {

using Eigen::Vector3d;

Vector3d random_point(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Pose random_pose(RandomStream& random, double size) {
  const Eigen::Vector4d q(random.normal(), random.normal(), random.normal(), random.normal());
  return {Eigen::Quaterniond(q.normalized()), random_point(random, size)};
}

Vector3d random_half(RandomStream& random) {
  return {random.uniform(0.05, 1.2), random.uniform(0.05, 1.2), random.uniform(0.05, 1.2)};
}

Vector3d onto_box(const Pose& X_WB, const Vector3d& half, const Vector3d& p_W) {
  return X_WB * Vector3d((X_WB.inverse() * p_W).cwiseMax(-half).cwiseMin(half));
}

/// Projected gradient with momentum for the QP min |a - b| over both boxes, with the gap's normal
/// as a lower bound: the answer lies between the two.
struct Bounds {
  double low = 0.0, high = 0.0;
};
Bounds bound_by_projections(const Pose& X_WA, const Vector3d& a, const Pose& X_WB,
                            const Vector3d& b) {
  Vector3d on_a = X_WA.p, before = on_a, start = on_a, on_b = X_WB.p;
  double momentum = 1.0;
  for (int k = 0; k < 5000; ++k) {
    on_b = onto_box(X_WB, b, start);
    before = on_a;
    on_a = onto_box(X_WA, a, on_b);
    const double next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    start = on_a + (momentum - 1.0) / next * (on_a - before);
    momentum = next;
    if ((start - on_a).dot(on_a - before) < 0.0) momentum = 1.0;
  }
  on_b = onto_box(X_WB, b, on_a);
  Bounds bounds;
  bounds.high = (on_a - on_b).norm();
  if (bounds.high < 1e-9) return bounds;
  const Vector3d n = (on_b - on_a) / bounds.high;
  const auto reach = [&n](const Pose& X, const Vector3d& half) {
    return (X.q.conjugate() * n).cwiseAbs().dot(half);
  };
  bounds.low = n.dot(X_WB.p - X_WA.p) - reach(X_WA, a) - reach(X_WB, b);
  return bounds;
}

TEST(BoxDistance, OfBoxesAlongTheAxesIsTheGap) {
  const Vector3d a(1.0, 0.5, 0.3), b(0.2, 0.4, 0.6);
  EXPECT_DOUBLE_EQ(box_distance_m({}, a, {Eigen::Quaterniond::Identity(), {3, 0, 0}}, b), 1.8);
  EXPECT_NEAR(box_distance_m({}, a, {Eigen::Quaterniond::Identity(), {4.2, -4.9, 0}}, b), 5.0,
              1e-12);
  EXPECT_EQ(box_distance_m({}, a, {Eigen::Quaterniond::Identity(), {1.2, 0, 0}}, b), 0.0);
  EXPECT_EQ(box_distance_m({}, a, {}, b), 0.0);
}

TEST(BoxDistance, OfACornerAndOfTwoCrossedEdgesIsThatOfGeometry) {
  const Vector3d cube = Vector3d::Ones();
  // A cube on its edge above a cube: sqrt(2) down to the edge.
  const Eigen::Quaterniond edge(Eigen::AngleAxisd(0.25 * kPi, Vector3d::UnitX()));
  EXPECT_NEAR(box_distance_m({}, cube, {edge, {0, 0, 4}}, cube), 3.0 - std::sqrt(2.0), 1e-12);
  // On its corner: sqrt(3).
  const Eigen::Quaterniond corner =
      Eigen::Quaterniond::FromTwoVectors(Vector3d(1, 1, 1), Vector3d(0, 0, -1));
  EXPECT_NEAR(box_distance_m({}, cube, {corner, {0.3, 0.2, 4}}, cube), 3.0 - std::sqrt(3.0), 1e-12);
  // Two edges at right angles: both cubes turned by 45 degrees, about x and about y.
  const Eigen::Quaterniond other(Eigen::AngleAxisd(0.25 * kPi, Vector3d::UnitY()));
  EXPECT_NEAR(box_distance_m({edge, {0, 0, 0}}, cube, {other, {0, 0, 4}}, cube),
              4.0 - 2.0 * std::sqrt(2.0), 1e-12);
}

TEST(BoxDistance, OfABoxInsideAnotherIsZero) {
  RandomStream random(1, "", "inside");
  for (int k = 0; k < 200; ++k) {
    const Pose outer = random_pose(random, 3.0);
    const Pose inner = outer * random_pose(random, 0.2);
    const Vector3d small = 0.1 * random_half(random);
    EXPECT_EQ(box_distance_m(outer, {2, 2, 2}, inner, small), 0.0);
    EXPECT_EQ(box_distance_m(inner, small, outer, {2, 2, 2}), 0.0);
  }
}

TEST(BoxDistance, LiesBetweenTheBoundsOfAQuadraticProgramme) {
  RandomStream random(2, "", "boxes");
  int apart = 0, together = 0;
  for (int k = 0; k < 2000; ++k) {
    const Pose X_WA = random_pose(random, 2.0), X_WB = random_pose(random, 2.0);
    const Vector3d a = random_half(random), b = random_half(random);
    const double distance = box_distance_m(X_WA, a, X_WB, b);
    const Bounds bounds = bound_by_projections(X_WA, a, X_WB, b);
    ASSERT_LE(distance, bounds.high + 1e-9) << k;
    ASSERT_GE(distance, bounds.low - 1e-9) << k;
    // The programme has converged, so the bounds say something.
    ASSERT_LT(bounds.high - std::max(bounds.low, 0.0), 1e-3) << k;
    ASSERT_NEAR(box_distance_m(X_WB, b, X_WA, a), distance, 1e-12) << k;
    (distance > 0.0 ? apart : together) += 1;
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(together, 300);
}

TEST(BoxDistance, NoSampleOfTheSurfacesIsNearer) {
  RandomStream random(3, "", "samples");
  for (int k = 0; k < 100; ++k) {
    const Pose X_WA = random_pose(random, 2.0), X_WB = random_pose(random, 2.0);
    const Vector3d a = random_half(random), b = random_half(random);
    const double distance = box_distance_m(X_WA, a, X_WB, b);
    double min_distance = 1e9;
    for (int face = 0; face < 6; ++face) {
      for (int i = 0; i <= 40; ++i) {
        for (int j = 0; j <= 40; ++j) {
          Vector3d p;
          p[face % 3] = face < 3 ? 1.0 : -1.0;
          p[(face + 1) % 3] = 0.05 * i - 1.0;
          p[(face + 2) % 3] = 0.05 * j - 1.0;
          const Vector3d p_W = X_WA * Vector3d(p.cwiseProduct(a));
          min_distance = std::min(min_distance, (onto_box(X_WB, b, p_W) - p_W).norm());
        }
      }
    }
    ASSERT_LE(distance, min_distance + 1e-12);
    // The grid is 0.06 m wide at most: half its diagonal is how far it can miss.
    if (distance > 0.0) {
      ASSERT_GT(distance, min_distance - 0.045);
    }
  }
}

TEST(BoxDistance, MovesWithTheBoxesAndTakesNoHeap) {
  RandomStream random(5, "", "moved");
  for (int k = 0; k < 200; ++k) {
    const Pose X_WA = random_pose(random, 2.0), X_WB = random_pose(random, 2.0);
    const Pose move = random_pose(random, 100.0);
    const Vector3d a = random_half(random), b = random_half(random);
    vinerow::test::AllocationCounter counter;
    const double here = box_distance_m(X_WA, a, X_WB, b);
    const double there = box_distance_m(move * X_WA, a, move * X_WB, b);
    EXPECT_EQ(counter.count(), 0u);
    EXPECT_NEAR(here, there, 1e-9);
  }
}

}  // namespace
}  // namespace vinerow::physics::box_distance_test
