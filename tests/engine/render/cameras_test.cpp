#include "engine/render/cameras.h"

#include <gtest/gtest.h>

#include "engine/render/culling.h"

namespace vinerow::render::cameras_test {
namespace {

TEST(Cameras, LookAtKeepsTargetInTheCentreAndTheHorizonLevel) {
  const Camera camera = look_at({3, -2, 5}, {10, 4, 1});
  Eigen::Vector2d centre;
  ASSERT_TRUE(project(camera, 640, 480, {10, 4, 1}, centre));
  EXPECT_NEAR(centre.x(), 320.0, 1e-9);  // exact up to rounding
  EXPECT_NEAR(centre.y(), 240.0, 1e-9);
  EXPECT_NEAR((camera.X_WC.q * Eigen::Vector3d::UnitX()).z(), 0.0, 1e-12);
  EXPECT_LT((camera.X_WC.q * Eigen::Vector3d::UnitY()).z(), 0.0);  // y of the picture points down
}

TEST(Cameras, LookingStraightDownHasNorthAtTheTop) {
  const Camera camera = look_at({0, 0, 10}, {0, 0, 0});
  EXPECT_NEAR((camera.X_WC.q * -Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitY()).norm(), 0.0,
              1e-12);
}

TEST(Cameras, OnBoardCameraLooksAlongTheBodysXAxis) {
  const Camera camera = on_board_camera({}, {Eigen::Quaterniond::Identity(), {0.5, 0, 0.3}});
  Eigen::Vector2d p;
  ASSERT_TRUE(project(camera, 200, 100, {10.5, 0, 0.3}, p));
  EXPECT_NEAR((p - Eigen::Vector2d(100, 50)).norm(), 0.0, 1e-9);
  // What is to the left of the body is in the left half; what is above is in the upper half.
  ASSERT_TRUE(project(camera, 200, 100, {10.5, 1, 1.3}, p));
  EXPECT_LT(p.x(), 100.0);
  EXPECT_LT(p.y(), 50.0);
  EXPECT_FALSE(project(camera, 200, 100, {-1, 0, 0}, p));
}

TEST(Cameras, ChaseCameraStandsBehindTheHeadingWhateverTheRoll) {
  const double yaw = 0.7;
  ChaseOptions options;
  options.distance_m = 4.0;
  options.height_m = 2.0;
  const Eigen::Vector3d eye(10 - 4 * std::cos(yaw), 20 - 4 * std::sin(yaw), 5);
  for (const double roll : {0.0, 0.3}) {
    const Pose X_WB{quaternion_from_rpy({roll, 0, yaw}), {10, 20, 3}};
    EXPECT_NEAR((chase_camera(X_WB, options).X_WC.p - eye).norm(), 0.0, 1e-9);
  }
}

TEST(Cameras, ChaseCameraKeepsItsHeightAboveASlope) {
  // Uphill by 20 % along x: a negative pitch lifts the nose.
  const Pose X_WB{quaternion_from_rpy({0, -std::atan(0.2), 0}), {0, 0, 0}};
  ChaseOptions options;
  options.distance_m = 5.0;
  options.height_m = 2.0;
  EXPECT_NEAR((chase_camera(X_WB, options).X_WC.p - Eigen::Vector3d(-5, 0, 2 - 5 * 0.2)).norm(),
              0.0, 1e-9);
}

TEST(Cameras, TopCameraShowsTheWholeBox) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-30, 5, 0), Eigen::Vector3d(90, 25, 8));
  for (const double aspect : {0.5, 1.0, 16.0 / 9.0}) {
    const int height = 480;
    const int width = static_cast<int>(aspect * height);
    const Camera camera = top_camera(box, aspect);
    for (int i = 0; i < 8; ++i) {
      Eigen::Vector2d p;
      const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
      ASSERT_TRUE(project(camera, width, height, box.corner(corner), p));
      EXPECT_GT(p.minCoeff(), 0.0);
      EXPECT_LT(p.x(), width);
      EXPECT_LT(p.y(), height);
    }
  }
}

TEST(Cameras, ClipMatrixAgreesWithThePinholeModel) {
  Camera camera = look_at({3, -2, 5}, {10, 4, 1}, 0.8);
  for (const bool orthographic : {false, true}) {
    camera.orthographic = orthographic;
    const Eigen::Matrix4d clip_from_world = calc_clip_from_world(camera, 640.0 / 480.0, 0.1, 100.0);
    const Eigen::Vector3d p_W(9.0, 3.0, 2.2);
    const Eigen::Vector4d clip = clip_from_world * p_W.homogeneous();
    const Eigen::Vector2d pixel(320.0 * (1.0 + clip.x() / clip.w()),
                                240.0 * (1.0 - clip.y() / clip.w()));
    Eigen::Vector2d expected;
    ASSERT_TRUE(project(camera, 640, 480, p_W, expected));
    EXPECT_NEAR((pixel - expected).norm(), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace vinerow::render::cameras_test
