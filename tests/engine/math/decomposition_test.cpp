#include "engine/math/decomposition.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <complex>
#include <vector>

namespace vinerow::decomposition_test {
namespace {

template <int n>
void expect_decomposed(const Eigen::Matrix<double, n, n>& A,
                       const Eigen::Matrix<double, n, 1>& values) {
  const SymmetricEigen<n> found = decompose_symmetric<n>(A);
  EXPECT_LT((found.values - values).norm(), 1e-12 * values.norm());
  const Eigen::Matrix<double, n, n> again =
      found.vectors * found.values.asDiagonal() * found.vectors.transpose();
  EXPECT_LT((again - A).norm(), 1e-12 * A.norm());
  EXPECT_TRUE((found.vectors.transpose() * found.vectors).isIdentity(1e-12));
}

// Roots of the characteristic polynomials by hand.
TEST(Decomposition, OfSymmetricMatrices) {
  expect_decomposed<2>(Eigen::Matrix2d{{2, 1}, {1, 2}}, {1, 3});
  expect_decomposed<3>(Eigen::Matrix3d{{2, 0, 0}, {0, 3, 4}, {0, 4, 9}}, {1, 2, 11});
  // The Laplacian of a ring of four, and 1.
  expect_decomposed<4>(
      Eigen::Matrix4d{{3, -1, 0, -1}, {-1, 3, -1, 0}, {0, -1, 3, -1}, {-1, 0, -1, 3}},
      {1, 3, 3, 5});
}

TEST(Decomposition, ReadsTheLowerTriangleAlone) {
  Eigen::Matrix2d A{{2, 1}, {1, 2}};
  A(0, 1) = 77.0;
  EXPECT_LT((decompose_symmetric<2>(A).values - Eigen::Vector2d(1, 3)).norm(), 1e-12);
}

TEST(Decomposition, EigenvaluesAreTheRootsOfTheCompanionsPolynomial) {
  // (x - 3) (x^2 - 2 x + 5) = x^3 - 5 x^2 + 11 x - 15: 3 and 1 +- 2i
  const Eigen::MatrixXd companion{{5, -11, 15}, {1, 0, 0}, {0, 1, 0}};
  const Eigen::VectorXcd values = calc_eigenvalues(companion);
  ASSERT_EQ(values.size(), 3);
  for (const std::complex<double> root :
       {std::complex<double>(3, 0), std::complex<double>(1, 2), std::complex<double>(1, -2)}) {
    EXPECT_LT((values.array() - root).abs().minCoeff(), 1e-12);
  }
}

TEST(Decomposition, LeastNormOfWhatIsLeftOpen) {
  // One equation: along its normal.
  EXPECT_LT(
      (solve_least_norm(Eigen::MatrixXd{{3, 4}}, Eigen::VectorXd{{50}}) - Eigen::Vector2d(6, 8))
          .norm(),
      1e-12);
  // A rank short: x + y = 2 twice over leaves x - y open.
  EXPECT_LT((solve_least_norm(Eigen::MatrixXd{{1, 1}, {2, 2}}, Eigen::VectorXd{{2, 4}}) -
             Eigen::Vector2d(1, 1))
                .norm(),
            1e-12);
  // Too many equations: the straight line y = 1 + x / 2 through (0,1), (1,2), (2,1), (3,3) by the
  // normal equations.
  EXPECT_LT((solve_least_norm(Eigen::MatrixXd{{1, 0}, {1, 1}, {1, 2}, {1, 3}},
                              Eigen::VectorXd{{1, 2, 1, 3}}) -
             Eigen::Vector2d(1, 0.5))
                .norm(),
            1e-12);
}

}  // namespace
}  // namespace vinerow::decomposition_test
