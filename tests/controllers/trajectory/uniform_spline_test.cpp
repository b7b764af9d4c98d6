// Spline against the closed form of the cubic B-spline.

#include "controllers/trajectory/uniform_spline.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace vinerow::test::uniform_spline_test {
namespace {

/// Cubic B-spline about 0 with knots at -2 .. 2, and its derivatives.
double kernel(double x, int derivative) {
  const double a = std::abs(x), sign = x < 0.0 ? -1.0 : 1.0, rest = 2.0 - a;
  if (a >= 2.0) return 0.0;
  if (derivative == 0)
    return a < 1.0 ? 2.0 / 3.0 - a * a + 0.5 * a * a * a : rest * rest * rest / 6.0;
  if (derivative == 1) return sign * (a < 1.0 ? -2.0 * a + 1.5 * a * a : -0.5 * rest * rest);
  return a < 1.0 ? -2.0 + 3.0 * a : rest;
}

const std::vector<double> kPoints = {1.0, -2.0, 0.5, 4.0, 4.0, -1.0};
constexpr double kStep = 0.4;

TEST(UniformSpline, IsTheSumOfItsKernels) {
  const controllers::UniformSpline<double> spline(kStep, kPoints);
  const int last = static_cast<int>(kPoints.size()) - 1;
  EXPECT_EQ(spline.pieces(), last);
  EXPECT_NEAR(spline.length(), last * kStep, 1e-15);
  const auto control = [&](int i) {  // beyond the ends: the end points' mirror images
    if (i < 0) return 2.0 * kPoints[0] - kPoints[1];
    if (i > last) return 2.0 * kPoints[last] - kPoints[last - 1];
    return kPoints[i];
  };
  for (int k = 0; k <= 200; ++k) {
    const double u = spline.length() * k / 200.0;
    double expected[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < 3; ++d) {
      for (int i = -1; i <= last + 1; ++i) {
        expected[d] += control(i) * kernel(u / kStep - i, d) / std::pow(kStep, d);
      }
    }
    EXPECT_NEAR(spline.at(u).value, expected[0], 1e-12) << u;
    EXPECT_NEAR(spline.at(u).first, expected[1], 1e-11) << u;
    EXPECT_NEAR(spline.at(u).second, expected[2], 1e-10) << u;
  }
}

TEST(UniformSpline, StartsInTheFirstPointAndEndsInTheLast) {
  const controllers::UniformSpline<double> spline(kStep, kPoints);
  for (const double u : {-7.0, 0.0}) EXPECT_NEAR(spline.at(u).value, kPoints.front(), 1e-12);
  for (const double u : {spline.length(), 99.0}) {
    EXPECT_NEAR(spline.at(u).value, kPoints.back(), 1e-12);
  }
}

TEST(UniformSpline, KeepsStraightLines) {
  const Eigen::Vector2d start(3.0, -1.0), slope(0.5, 2.0);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 5; ++i) points.push_back(start + kStep * i * slope);
  const controllers::UniformSpline<Eigen::Vector2d> spline(kStep, points);
  for (const double u : {0.0, 0.1, 0.77, 1.6}) {
    EXPECT_NEAR((spline.at(u).value - start - u * slope).norm(), 0.0, 1e-12);
    EXPECT_NEAR((spline.at(u).first - slope).norm(), 0.0, 1e-12);
    EXPECT_NEAR(spline.at(u).second.norm(), 0.0, 1e-11);
  }
}

TEST(UniformSpline, TwoPointsAreOnePiece) {
  const controllers::UniformSpline<double> spline(2.0, {1.0, 5.0});
  EXPECT_EQ(spline.pieces(), 1);
  EXPECT_EQ(spline.piece_at(2.0), 0);
  EXPECT_NEAR(spline.at(0.5).value, 2.0, 1e-12);
}

}  // namespace
}  // namespace vinerow::test::uniform_spline_test
