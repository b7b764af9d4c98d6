#include "engine/math/pose.h"

#include <gtest/gtest.h>

#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::pose_test {
namespace {

using Eigen::Vector3d;

TEST(Pose, CompositionMapsPointsThroughBothFrames) {
  const Pose X_AB{quaternion_from_rpy({0, 0, kPi / 2}), {1, 0, 0}};
  const Pose X_BC{quaternion_from_rpy({kPi / 2, 0, 0}), {0, 2, 0}};
  // By hand: p_C = (0,0,1) -> B: Rx(90) z = -y -> (0,-1,0) + (0,2,0) = (0,1,0) -> A: Rz(90) y = -x
  // -> (-1,0,0) + (1,0,0).
  EXPECT_NEAR(((X_AB * X_BC) * Vector3d(0, 0, 1) - Vector3d(0, 0, 0)).norm(), 0.0, 1e-15);
}

TEST(Pose, InverseUndoesThePose) {
  const Pose X{quaternion_from_rpy({0.3, -0.4, 2.0}), {3, -2, 1}};
  EXPECT_NEAR((X.inverse() * (X * Vector3d(1, 2, 3)) - Vector3d(1, 2, 3)).norm(), 0.0, 1e-14);
}

TEST(Pose, AnglesComeBackFromTheQuaternion) {
  RandomStream random(1, "", "pose");
  for (int i = 0; i < 1000; ++i) {
    const RollPitchYaw in{random.uniform(-3.1, 3.1), random.uniform(-1.5, 1.5),
                          random.uniform(-3.1, 3.1)};
    const RollPitchYaw out = rpy_from_quaternion(quaternion_from_rpy(in));
    // Near pitch 90 deg the angles lose half the digits.
    EXPECT_NEAR(out.roll_rad, in.roll_rad, 1e-12);
    EXPECT_NEAR(out.pitch_rad, in.pitch_rad, 1e-12);
    EXPECT_NEAR(out.yaw_rad, in.yaw_rad, 1e-12);
  }
}

TEST(Pose, PositivePitchLowersTheNose) {
  EXPECT_LT((quaternion_from_rpy({0, 0.1, 0}) * Vector3d::UnitX()).z(), 0.0);
}

TEST(Pose, StandingOnASlopeKeepsTheHeading) {
  const Vector3d normal = Vector3d(-0.2, 0.1, 1.0).normalized();
  for (const double yaw : {-3.0, -1.0, 0.0, 0.7, 2.5}) {
    const Eigen::Quaterniond q = quaternion_on_slope(yaw, normal);
    EXPECT_NEAR((q * Vector3d::UnitZ() - normal).norm(), 0.0, 1e-14);
    EXPECT_NEAR(yaw_from_quaternion(q), yaw, 1e-14);
  }
}

TEST(Angles, WrapKeepsTheDirectionAndPicksTheHalfOpenRange) {
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(7.0), 7.0 - 2.0 * kPi, 1e-15);
  EXPECT_NEAR(wrap_angle(-7.0), 2.0 * kPi - 7.0, 1e-15);
}

}  // namespace
}  // namespace vinerow::pose_test
