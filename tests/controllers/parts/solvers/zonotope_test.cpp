#include "controllers/parts/solvers/zonotope.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "controllers/parts/solvers/polytope.h"
#include "controllers/parts/solvers/series_support.h"
#include "tests/controllers/parts/solvers/random_sets.h"

namespace vinerow::test::zonotope_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The largest c'x over all 2^k sign patterns of the generators.
double best_corner(const controllers::Zonotope& Z, const Eigen::VectorXd& c) {
  const int k = static_cast<int>(Z.generators().cols());
  double best = -std::numeric_limits<double>::infinity();
  for (int pattern = 0; pattern < (1 << k); ++pattern) {
    Eigen::VectorXd x = Z.centre();
    for (int j = 0; j < k; ++j) x += ((pattern >> j) & 1 ? 1.0 : -1.0) * Z.generators().col(j);
    best = std::max(best, c.dot(x));
  }
  return best;
}

TEST(Zonotope, SupportIsTheBestCorner) {
  RandomStream random(1, "", "zonotope");
  for (int run = 0; run < 30; ++run) {
    const int n = 1 + run % 5, k = run % 9;
    const controllers::Zonotope Z(normal_matrix(random, n, 1), normal_matrix(random, n, k));
    const Eigen::VectorXd c = normal_matrix(random, n, 1);
    EXPECT_NEAR(Z.support(c), best_corner(Z, c), 1e-12);
    EXPECT_NEAR(Z.half_widths()[0] + Z.centre()[0], Z.support(Eigen::VectorXd::Unit(n, 0)), 1e-12);
  }
  EXPECT_EQ(
      controllers::Zonotope::box(Eigen::Vector2d(2.0, 0.5)).support(Eigen::Vector2d(-1.0, 4.0)),
      4.0);
}

TEST(Zonotope, ImagesMapTheirSupports) {
  RandomStream random(2, "", "zonotope");
  const controllers::Zonotope Z(normal_matrix(random, 3, 1), normal_matrix(random, 3, 4));
  const Eigen::MatrixXd M = normal_matrix(random, 2, 3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d c = normal_matrix(random, 3, 1);
    const Eigen::Vector2d d = normal_matrix(random, 2, 1);
    EXPECT_NEAR(Z.linear_image(M).support(d), best_corner(Z, M.transpose() * d), 1e-12);
    EXPECT_NEAR(Z.scaled(-2.0).support(c), 2.0 * best_corner(Z, -c), 1e-12);
  }
}

TEST(Zonotope, RefusesWhatDoesNotFit) {
  const Eigen::Vector2d two(1.0, 2.0);
  const controllers::Zonotope Z(two, Eigen::MatrixXd::Ones(2, 3));
  EXPECT_EQ(complaint([&] { controllers::Zonotope(two, Eigen::MatrixXd::Ones(3, 1)); }),
            "a zonotope around a point of 2 numbers has generators of 3");
  EXPECT_EQ(complaint([&] { controllers::Zonotope(two, Eigen::MatrixXd::Constant(2, 1, kNaN)); }),
            "a zonotope contains a number that is not finite");
  EXPECT_EQ(complaint([&] { controllers::Zonotope::box(Eigen::Vector2d(1.0, -0.5)); }),
            "half width 1 of a box is -0.5, must be >= 0");
  EXPECT_EQ(complaint([&] { Z.support(Eigen::Vector3d::Ones()); }),
            "a zonotope in 2 dimensions does not match a direction in 3");
  EXPECT_EQ(complaint([&] { Z.linear_image(Eigen::MatrixXd::Ones(2, 3)); }),
            "a zonotope in 2 dimensions does not match a matrix of 3 columns");
}

TEST(SeriesSupport, ReproducesTheExampleOfRakovic) {
  // Rakovic, Kerrigan, Kouramas, Mayne, IEEE TAC 50(3), 2005: A_K = [-.17 -.03; -1.17 -.03] and a
  // unit box. The set has half widths 100/77 and 200/77.
  Eigen::Matrix2d A;
  A << -0.17, -0.03, -1.17, -0.03;
  const Result<controllers::SeriesSupport> exact =
      controllers::SeriesSupport::make(A, controllers::Polytope::box(Eigen::Vector2d(1.0, 1.0)));
  ASSERT_TRUE(exact);
  EXPECT_NEAR((*exact)(Eigen::Vector2d::UnitX()), 100.0 / 77.0, 1e-10);
  EXPECT_NEAR((*exact)(Eigen::Vector2d::UnitY()), 200.0 / 77.0, 1e-10);
}

TEST(SeriesSupport, ScalarIsTheGeometricSeries) {
  for (const double a : {0.0, 0.5, -0.9, 0.999}) {
    const Result<controllers::SeriesSupport> series = controllers::SeriesSupport::make(
        Eigen::MatrixXd::Constant(1, 1, a),
        controllers::Zonotope::box(Eigen::VectorXd::Constant(1, 0.3)));
    ASSERT_TRUE(series);
    const double expected = 2.0 * 0.3 / (1.0 - std::abs(a));
    const controllers::SeriesSupport::Bound bound =
        series->bound(Eigen::VectorXd::Constant(1, -2.0));
    EXPECT_NEAR(bound.value, expected, 1e-11 * expected);
    EXPECT_LE(bound.excess, 3e-12 * expected);
  }
}

TEST(SeriesSupport, ContractedQuarterTurn) {
  // A = r [0 -1; 1 0] swaps the axes at each step: even steps add one half width, odd ones the
  // other.
  const double r = 0.8;
  Eigen::Matrix2d A;
  A << 0.0, -r, r, 0.0;
  const Eigen::Vector2d half(0.1, 0.4);
  const Result<controllers::SeriesSupport> series =
      controllers::SeriesSupport::make(A, controllers::Zonotope::box(half));
  ASSERT_TRUE(series);
  EXPECT_NEAR((*series)(Eigen::Vector2d(1.0, 0.0)), (0.1 + r * 0.4) / (1.0 - r * r), 1e-11);
  EXPECT_NEAR((*series)(Eigen::Vector2d(0.0, 1.0)), (0.4 + r * 0.1) / (1.0 - r * r), 1e-11);
  // The same set as a polytope gives the same.
  const Result<controllers::SeriesSupport> again =
      controllers::SeriesSupport::make(A, controllers::Polytope::box(half));
  ASSERT_TRUE(again);
  EXPECT_NEAR((*again)(Eigen::Vector2d(0.3, -2.0)), (*series)(Eigen::Vector2d(0.3, -2.0)), 1e-11);
}

TEST(SeriesSupport, BoundIsAboveALongSumAndNoHigherThanItsExcess) {
  RandomStream random(3, "", "zonotope");
  for (int run = 0; run < 20; ++run) {
    const int n = 1 + run % 6;
    Eigen::MatrixXd A = normal_matrix(random, n, n);
    A *= 0.95 / A.norm();  // at least the largest singular value
    const controllers::Zonotope W(normal_matrix(random, n, 1), normal_matrix(random, n, 2));
    const Result<controllers::SeriesSupport> series = controllers::SeriesSupport::make(A, W);
    ASSERT_TRUE(series);
    const Eigen::VectorXd c = normal_matrix(random, n, 1);
    const controllers::SeriesSupport::Bound bound = series->bound(c);
    Eigen::VectorXd moved = c;
    double sum = 0.0;
    for (int j = 0; j < 5000; ++j, moved = A.transpose() * moved) sum += W.support(moved);
    const double rounding = 1e-12 * (1.0 + std::abs(sum));
    EXPECT_GE(bound.value, sum - rounding);
    EXPECT_LE(bound.value, sum + bound.excess + rounding);
  }
}

TEST(SeriesSupport, CentreOfTheDisturbanceMovesTheWholeSet) {
  // A fixed disturbance has the equilibrium (I - A)^-1 w as its only limit.
  Eigen::Matrix2d A;
  A << 0.9, 0.2, -0.1, 0.7;
  const Eigen::Vector2d w(0.3, -1.0), c(-0.4, 2.0);
  const Result<controllers::SeriesSupport> series =
      controllers::SeriesSupport::make(A, controllers::Zonotope(w, Eigen::MatrixXd(2, 0)));
  ASSERT_TRUE(series);
  const Eigen::Vector2d rest = (Eigen::Matrix2d::Identity() - A).inverse() * w;
  EXPECT_NEAR((*series)(c), c.dot(rest), 1e-10);
  EXPECT_NEAR((*series)(-c), -c.dot(rest), 1e-10);
}

TEST(SeriesSupport, RefusesUnstableSystemsAndOddDisturbances) {
  const Eigen::Matrix2d A = Eigen::Vector2d(0.5, 1.02).asDiagonal();
  const Eigen::Matrix2d slow = Eigen::Vector2d(0.5, 0.3).asDiagonal();
  const controllers::Zonotope box = controllers::Zonotope::box(Eigen::Vector2d(1.0, 1.0));
  EXPECT_EQ(controllers::SeriesSupport::make(A, box).reason(),
            "A is not Schur stable: its spectral radius is 1.02, must be < 1");
  EXPECT_EQ(controllers::SeriesSupport::make(Eigen::Matrix2d::Identity(), box).reason(),
            "A is not Schur stable: its spectral radius is 1, must be < 1");
  EXPECT_EQ(controllers::SeriesSupport::make(0.9999999 * Eigen::Matrix2d::Identity(), box).reason(),
            "1000000 steps of A do not halve every state: its spectral radius is 0.9999999");
  EXPECT_EQ(controllers::SeriesSupport::make(slow, controllers::Polytope::empty_set(2)).reason(),
            "the disturbance set is empty");
  EXPECT_EQ(controllers::SeriesSupport::make(
                slow, controllers::Polytope(Eigen::RowVector2d(1.0, 0.0), Eigen::VectorXd::Ones(1)))
                .reason(),
            "the disturbance set is unbounded along state 0");
  EXPECT_EQ(
      complaint([&] { (void)controllers::SeriesSupport::make(Eigen::MatrixXd::Zero(2, 3), box); }),
      "A is 2 x 3, must be square");
  EXPECT_EQ(complaint([&] { (void)controllers::SeriesSupport::make(kNaN * slow, box); }),
            "A contains a number that is not finite");
  EXPECT_EQ(
      complaint([&] { (void)controllers::SeriesSupport::make(Eigen::Matrix3d::Zero(), box); }),
      "a zonotope in 2 dimensions does not match a direction in 3");
  EXPECT_EQ(
      complaint([&] { (*controllers::SeriesSupport::make(slow, box))(Eigen::Vector3d::Ones()); }),
      "a set in 2 dimensions does not match a direction in 3");
}

}  // namespace
}  // namespace vinerow::test::zonotope_test
