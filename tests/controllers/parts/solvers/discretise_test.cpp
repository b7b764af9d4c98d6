/// Sampled models with known closed forms.

#include "controllers/parts/solvers/discretise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::test::discretise_test {
namespace {

using Eigen::MatrixXd;

MatrixXd matrix(int rows, int columns, std::initializer_list<double> numbers) {
  MatrixXd result(rows, columns);
  const double* number = numbers.begin();
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) result(i, j) = *number++;
  }
  return result;
}

void expect_near(const MatrixXd& reached, const MatrixXd& expected, double tolerance) {
  ASSERT_EQ(reached.rows(), expected.rows());
  ASSERT_EQ(reached.cols(), expected.cols());
  EXPECT_LE((reached - expected).cwiseAbs().maxCoeff(), tolerance) << reached << "\nexpected\n"
                                                                   << expected;
}

TEST(Discretise, DoubleIntegrator) {
  const double T = 0.3;
  const controllers::SampledModel model =
      controllers::discretise(matrix(2, 2, {0, 1, 0, 0}), matrix(2, 1, {0, 1}), T);
  expect_near(model.A, matrix(2, 2, {1, T, 0, 1}), 1e-16);
  expect_near(model.B, matrix(2, 1, {T * T / 2, T}), 1e-16);
}

TEST(Discretise, Oscillator) {
  // x'' = -w^2 (x - u), from slow to several turns within one sample
  for (const double w : {0.2, 3.0, 70.0}) {
    const double T = 0.5, c = std::cos(w * T), s = std::sin(w * T);
    const controllers::SampledModel model =
        controllers::discretise(matrix(2, 2, {0, 1, -w * w, 0}), matrix(2, 1, {0, w * w}), T);
    const double tolerance = 1e-13 * (1.0 + w * w);
    expect_near(model.A, matrix(2, 2, {c, s / w, -w * s, c}), tolerance);
    expect_near(model.B, matrix(2, 1, {1 - c, w * s}), tolerance);
  }
}

TEST(Discretise, FirstOrderLagsWithInputsInAnyUnit) {
  // x' = -x / lag + gain u: a unit a million times smaller takes no digit from A
  for (const double gain : {1e-9, 1.0, 1e9}) {
    const double T = 0.05, fast = 0.02, slow = 2.0;
    const controllers::SampledModel model = controllers::discretise(
        matrix(2, 2, {-1 / fast, 0, 0, -1 / slow}), matrix(2, 2, {gain, 0, 0, 1 / slow}), T);
    expect_near(model.A, matrix(2, 2, {std::exp(-T / fast), 0, 0, std::exp(-T / slow)}), 4e-16);
    EXPECT_NEAR(model.B(0, 0) / (-gain * fast * std::expm1(-T / fast)), 1.0, 1e-14);
    EXPECT_NEAR(model.B(1, 1) / -std::expm1(-T / slow), 1.0, 1e-14);
    EXPECT_EQ(model.B(0, 1), 0.0);
  }
}

TEST(Discretise, ModelWithoutInputs) {
  const controllers::SampledModel model =
      controllers::discretise(matrix(1, 1, {-2}), MatrixXd(1, 0), 0.5);
  EXPECT_NEAR(model.A(0, 0), std::exp(-1.0), 1e-16);
  EXPECT_EQ(model.B.cols(), 0);
}

TEST(Discretise, StructuralZerosStayZero) {
  // A chain p, v, angle, rate with a rate on its own beside it: what does not act on a state is an
  // exact zero, so that condensed rows and products can leave it out.
  MatrixXd A = MatrixXd::Zero(5, 5), B = MatrixXd::Zero(5, 2);
  A(0, 1) = A(2, 3) = 1.0;
  A(1, 2) = 9.81;
  A(1, 1) = -0.1;
  A(4, 4) = -0.3;
  B(3, 0) = 80.0;
  B(4, 1) = 5.0;
  const controllers::SampledModel model = controllers::discretise(A, B, 0.05);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const bool acts = i == j || (i < j && j < 4);
      EXPECT_EQ(model.A(i, j) != 0.0, acts) << i << ' ' << j;
    }
    EXPECT_EQ(model.B(i, 0) != 0.0, i < 4);
    EXPECT_EQ(model.B(i, 1) != 0.0, i == 4);
  }
}

}  // namespace
}  // namespace vinerow::test::discretise_test
