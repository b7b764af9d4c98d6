#include "worlds/mapping/photogrammetry/triangulation.h"

#include <gtest/gtest.h>

#include "engine/core/random.h"
#include "tests/worlds/mapping/photogrammetry/cloud_scene.h"

namespace vinerow::mapping::triangulation_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(SurveyView, ShowsAPyramidBelowTheCamera) {
  SurveyCamera camera = test::square_camera();
  camera.sensor_width_mm = 10.0;  // twice as wide to the sides, which are north and south
  const SurveyView view(camera, test::looking_down(10.0, 20.0, 50.0));
  EXPECT_TRUE(view.shows({10.0 + 24.9, 20.0 + 49.9, 0.0}));
  EXPECT_FALSE(view.shows({10.0 + 25.1, 20.0, 0.0}));
  EXPECT_FALSE(view.shows({10.0, 20.0 - 50.1, 0.0}));
  EXPECT_FALSE(view.shows({10.0, 20.0, 51.0})) << "behind the camera";
  EXPECT_TRUE(view.may_show({10.0 + 27.0, 20.0, 0.0}, 2.0));
  EXPECT_FALSE(view.may_show({10.0 + 27.5, 20.0, 0.0}, 2.0));
}

TEST(SurveyView, ShowsAllOfABallOnlyIfItShowsEveryPointOfIt) {
  const Pose pose{quaternion_from_rpy({0.2, 1.3, -0.7}), {3.0, -4.0, 60.0}};
  SurveyCamera camera = test::square_camera();
  camera.sensor_height_mm = 4.0;
  const SurveyView view(camera, pose);
  RandomStream random(1, "", "balls");
  int whole = 0, part = 0;
  for (int k = 0; k < 2000; ++k) {
    const double x = random.uniform(-5, 70), y = random.uniform(-40, 40);
    const Vector3d centre = pose * Vector3d(x, y, random.uniform(-30, 30));
    const double radius_m = random.uniform(0.1, 8.0);
    int shown = 0;
    constexpr int kPoints = 50;
    for (int n = 0; n < kPoints; ++n) {
      const double u = random.normal(), v = random.normal(), w = random.normal();
      shown += view.shows(centre + radius_m * Vector3d(u, v, w).normalized()) ? 1 : 0;
    }
    if (view.shows_all(centre, radius_m)) {
      ++whole;
      EXPECT_EQ(shown, kPoints);
      EXPECT_TRUE(view.may_show(centre, radius_m));
    } else if (shown == kPoints) {
      ++part;  // the nearest edge lies between the points
    }
  }
  EXPECT_GT(whole, 300);
  EXPECT_LT(part, whole / 10);
}

TEST(SurveyView, PixelsGoToTheRightAndDown) {
  const SurveyView view(test::square_camera(), test::looking_down(0.0, 0.0, 100.0));
  // 1000 pixels show 100 m. Ahead is east, so the right is south.
  EXPECT_TRUE(view.pixel({10.0, -20.0, 0.0}).isApprox(Eigen::Vector2d(200.0, -100.0), 1e-12));
}

TEST(SurveyView, JacobianIsTheDerivativeOfThePixel) {
  const Pose pose{quaternion_from_rpy({0.2, 1.3, -0.7}), {3.0, -4.0, 60.0}};
  SurveyCamera camera = test::square_camera();
  camera.sensor_height_mm = 4.0;
  const SurveyView view(camera, pose);
  const Vector3d p = pose * Vector3d(55.0, 7.0, -11.0);
  const auto J = view.jacobian(p);
  const double h = 1e-4;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = h * Vector3d::Unit(axis);
    const Eigen::Vector2d slope = (view.pixel(p + step) - view.pixel(p - step)) / (2.0 * h);
    EXPECT_TRUE(J.col(axis).isApprox(slope, 1e-7)) << axis;
  }
}

Triangulation seen_from(const std::vector<double>& x_m, double height_m) {
  Triangulation triangulation;
  for (const double x : x_m) {
    triangulation.add(SurveyView(test::square_camera(), test::looking_down(x, 0.0, height_m)),
                      Vector3d::Zero());
  }
  return triangulation;
}

// A camera at (x, 0, h) straight above sees (0, 0, 0) with u ~ f y / h, v ~ f (x + X) / (h - Z), so
// J = f / h [0 1 0; 1 0 x/h] up to signs, and of cameras at +-b the mixed terms cancel.
TEST(Triangulation, TwoCamerasHaveTheNormalCaseOfStereo) {
  const double h = 80.0, b = 10.0, f = 1000.0, px = 0.5;
  const Matrix3d covariance = seen_from({-b, b}, h).covariance_m2(px);
  const double across2 = px * px * h * h / (f * f);
  const Matrix3d expected =
      Vector3d(across2 / 2, across2 / 2, across2 * h * h / (2 * b * b)).asDiagonal();
  EXPECT_TRUE(covariance.isApprox(expected, 1e-9)) << covariance;
}

TEST(Triangulation, AThirdCameraInTheMiddleHelpsAcrossOnly) {
  const double h = 80.0, b = 10.0, f = 1000.0, px = 0.3;
  const Matrix3d covariance = seen_from({-b, 0.0, b}, h).covariance_m2(px);
  const double across2 = px * px * h * h / (f * f);
  const Matrix3d expected =
      Vector3d(across2 / 3, across2 / 3, across2 * h * h / (2 * b * b)).asDiagonal();
  EXPECT_TRUE(covariance.isApprox(expected, 1e-9)) << covariance;
}

// Errors F n of independent standard normals n have the covariance F F^T; the columns of F are the
// errors of the unit vectors. Eigen computes the covariance.
TEST(Triangulation, ErrorsHaveItsCovariance) {
  Triangulation triangulation;
  const Vector3d rolls(0.3, -0.2, 0.5);
  for (int k = 0; k < 3; ++k) {
    const Pose pose = test::looking_down(20.0 * k - 15.0, 9.0 * k * k - 7.0, 60.0 + 5.0 * k);
    const Pose rolled{pose.q * quaternion_from_rpy({rolls[k], 0.1 * k, -0.2}), pose.p};
    triangulation.add(SurveyView(test::square_camera(), rolled), {3.0, -2.0, 1.5});
  }
  Matrix3d factor;
  for (int k = 0; k < 3; ++k) factor.col(k) = triangulation.error_m(0.5, Vector3d::Unit(k));
  const Matrix3d expected = triangulation.covariance_m2(0.5);
  EXPECT_TRUE((factor * factor.transpose()).isApprox(expected, 1e-9)) << expected;
  const Matrix3d cross = expected.cwiseAbs() - Matrix3d(expected.diagonal().asDiagonal());
  EXPECT_GT(cross.maxCoeff(), 0.05 * expected.diagonal().minCoeff());  // no special case
}

}  // namespace
}  // namespace vinerow::mapping::triangulation_test
