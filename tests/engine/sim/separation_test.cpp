#include "engine/sim/separation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "engine/physics/box_distance.h"
#include "tests/support/no_alloc.h"

namespace vinerow::separation_test {
namespace {

using Eigen::Vector3d;

const Vector3d kHalf_m(1.0, 0.5, 0.4);

Pose at(double x, double y, double yaw_rad = 0.0) {
  return {quaternion_from_rpy({0, 0, yaw_rad}), {x, y, 0}};
}

constexpr Time tick(std::int64_t i) {
  return {i * 20'000'000};
}

TEST(Separation, OfTwoThatPassEachOtherIsTheGapBetweenTheirCorners) {
  Separation separation(2);
  const Vector3d half_m(1.0, 1.0, 0.4);
  for (int i = 0; i <= 1000; ++i) {
    const double x = 0.02 * i;
    separation.place(0, at(x, 0.0, 0.25 * kPi), Vector3d::Zero(), half_m);
    separation.place(1, at(20.0 - x, 5.0, 0.25 * kPi), Vector3d::Zero(), half_m);
    separation.update(tick(i));
  }
  for (const int vehicle : {0, 1}) {
    const Separation::MinDistance& closest = separation.closest(vehicle);
    EXPECT_NEAR(closest.distance_m, 5.0 - 2.0 * std::sqrt(2.0), 1e-12);
    EXPECT_EQ(closest.other, 1 - vehicle);
    EXPECT_NEAR(closest.time.s(), 10.0, 1e-9);
    EXPECT_NEAR((closest.p_W - Vector3d(10.0, vehicle == 0 ? 0.0 : 5.0, 0.0)).norm(), 0.0, 1e-9);
  }
}

TEST(Separation, TellsWhoOfManyAndEveryPair) {
  Separation separation(4);
  separation.place(0, at(0, 0), Vector3d::Zero(), kHalf_m);
  separation.place(1, at(5, 0), Vector3d::Zero(), kHalf_m);
  separation.place(2, at(5, 4), Vector3d::Zero(), kHalf_m);
  separation.update(tick(0));
  EXPECT_EQ(separation.closest(0).other, 1);
  EXPECT_DOUBLE_EQ(separation.closest(0).distance_m, 3.0);
  EXPECT_DOUBLE_EQ(separation.closest(2).distance_m, 3.0);
  EXPECT_NEAR(separation.closest(0, 2).distance_m, std::hypot(3.0, 3.0), 1e-12);
  EXPECT_EQ(separation.closest(0, 2).other, 2);
  EXPECT_EQ(separation.closest(2, 0).other, 0);
  EXPECT_EQ(separation.closest(2, 0).p_W, Vector3d(5, 4, 0));
  // The fourth was never there.
  EXPECT_EQ(separation.closest(3).other, -1);
  EXPECT_TRUE(std::isinf(separation.closest(3).distance_m));
  // The first goes; what comes near its place is not near it.
  separation.remove(0);
  separation.place(3, at(0, 0), Vector3d::Zero(), kHalf_m);
  separation.update(tick(1));
  EXPECT_DOUBLE_EQ(separation.closest(0).distance_m, 3.0);
  EXPECT_DOUBLE_EQ(separation.closest(3).distance_m, 3.0);
}

TEST(Separation, TheBoxSitsWhereItIsOnTheVehicle) {
  Separation separation(2);
  separation.place(0, at(0, 0, 0.5 * kPi), {2, 0, 0}, kHalf_m);  // its box is at y = 2
  separation.place(1, at(0, 6), Vector3d::Zero(), kHalf_m);
  separation.update(tick(0));
  EXPECT_NEAR(separation.closest(0).distance_m, 2.5, 1e-12);
  EXPECT_NEAR((separation.closest(0).p_W - Vector3d(0, 2, 0)).norm(), 0.0, 1e-12);
}

TEST(Separation, IsTheLeastOfAllTicksWithoutHeap) {
  RandomStream random(1, "", "walk");
  Separation separation(3);
  Pose poses[3] = {at(0, 0), at(4, 0), at(0, 4)};
  double closest[3][3];
  for (auto& row : closest) std::fill(std::begin(row), std::end(row), 1e9);
  std::size_t allocations = 0;
  for (int i = 0; i < 3000; ++i) {
    for (int v = 0; v < 3; ++v) {
      poses[v].p += Vector3d(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.0);
      poses[v].q = quaternion_from_rpy({0.0, 0.0, random.uniform(-3.0, 3.0)});
    }
    test::AllocationCounter counter;
    for (int v = 0; v < 3; ++v) separation.place(v, poses[v], Vector3d::Zero(), kHalf_m);
    separation.update(tick(i));
    allocations += counter.count();
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        if (a == b) continue;
        closest[a][b] =
            std::min(closest[a][b], physics::box_distance_m(poses[a], kHalf_m, poses[b], kHalf_m));
      }
    }
  }
  EXPECT_EQ(allocations, 0u);
  for (int a = 0; a < 3; ++a) {
    double own = 1e9;
    for (int b = 0; b < 3; ++b) {
      if (a == b) continue;
      EXPECT_NEAR(separation.closest(a, b).distance_m, closest[a][b], 1e-12);
      own = std::min(own, closest[a][b]);
    }
    EXPECT_NEAR(separation.closest(a).distance_m, own, 1e-12);
  }
}

}  // namespace
}  // namespace vinerow::separation_test
