#include "controllers/parts/solvers/qp.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "tests/controllers/parts/solvers/qp_support.h"

namespace vinerow::test::qp_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Qp, UnconstrainedMinimumIsNewtonsStep) {
  QpProblem problem(2, 0);
  problem.H << 4.0, 1.0, 1.0, 3.0;
  problem.f << -1.0, -2.0;
  controllers::QpSolver solver(2, 0);
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_NEAR(solver.x()[0], 1.0 / 11.0, 1e-15);
  EXPECT_NEAR(solver.x()[1], 7.0 / 11.0, 1e-15);
  EXPECT_NEAR(solver.cost(), -0.5 * (1.0 / 11.0 + 14.0 / 11.0), 1e-15);  // f'x / 2
  EXPECT_TRUE(solver.active_set().empty());
  EXPECT_EQ(solver.iterations(), 0);
}

TEST(Qp, ReadsTheLowerTriangleOfTheHessian) {
  Eigen::Matrix2d H;
  H << 4.0, kNaN, 1.0, 3.0;
  QpProblem problem(2, 0);
  problem.f << -1.0, -2.0;
  controllers::QpSolver solver(2, 0);
  ASSERT_TRUE(solver.set_hessian(H));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_NEAR(solver.x()[1], 7.0 / 11.0, 1e-15);
}

TEST(Qp, ProjectsOnABox) {
  RandomStream random(1, "", "qp");
  for (int run = 0; run < 50; ++run) {
    const int n = 1 + run % 12;
    QpProblem problem(n, 0);
    const Eigen::VectorXd point = random_matrix(random, n, 1);
    problem.f = -point;
    problem.lower.setConstant(-0.7);
    problem.upper.setConstant(0.4);
    controllers::QpSolver solver(n, 0);
    ASSERT_TRUE(problem.prepare(solver));
    ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
    const Eigen::VectorXd expected = point.cwiseMax(-0.7).cwiseMin(0.4);
    EXPECT_LT((solver.x() - expected).cwiseAbs().maxCoeff(), 1e-15);
    // At a limit the multiplier is how far the point lies outside: positive at the upper one.
    EXPECT_LT((solver.multipliers() - (point - expected)).cwiseAbs().maxCoeff(), 1e-15);
  }
}

TEST(Qp, ProjectsOnAHalfSpaceFromEitherSide) {
  QpProblem problem(3, 1);
  problem.A << 1.0, 2.0, 2.0;
  problem.f << -3.0, 0.0, 0.0;
  problem.row_lower << -kInfinity;
  problem.row_upper << 0.0;
  controllers::QpSolver solver(3, 1);
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_LT((solver.x() - Eigen::Vector3d(8.0, -2.0, -2.0) / 3.0).norm(), 1e-14);
  EXPECT_NEAR(solver.multipliers()[3], 1.0 / 3.0, 1e-15);
  problem.row_lower << 6.0;
  problem.row_upper << kInfinity;
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_LT((solver.x() - Eigen::Vector3d(10.0, 2.0, 2.0) / 3.0).norm(), 1e-14);
  EXPECT_NEAR(solver.multipliers()[3], -1.0 / 3.0, 1e-15);
  EXPECT_EQ(solver.active_set(), std::vector<int>{3});
}

TEST(Qp, EqualitiesAgreeWithTheKktSystemByLu) {
  RandomStream random(2, "", "qp");
  for (int run = 0; run < 100; ++run) {
    const int n = 3 + run % 20, m = 1 + run % (n - 1);
    QpProblem problem(n, m);
    problem.H = random_hessian(random, n, 3.0);
    problem.f = random_matrix(random, n, 1);
    problem.A = random_matrix(random, m, n);
    problem.row_lower = problem.row_upper = random_matrix(random, m, 1);
    Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + m, n + m);
    kkt << problem.H, problem.A.transpose(), problem.A, Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd right(n + m);
    right << -problem.f, problem.row_lower;
    const Eigen::VectorXd expected = kkt.fullPivLu().solve(right);
    controllers::QpSolver solver(n, m);
    ASSERT_TRUE(problem.prepare(solver));
    ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
    EXPECT_LT((solver.x() - expected.head(n)).norm(), 1e-10 * (1.0 + expected.head(n).norm()));
    EXPECT_LT((solver.multipliers().tail(m) - expected.tail(m)).norm(),
              1e-10 * (1.0 + expected.tail(m).norm()));
  }
}

TEST(Qp, SoftRowGivesWayByItsMultiplierOverItsWeight) {
  // min 1/2 (x - 3)^2 + 1/2 w s^2 with x <= 1 + s: x = (3 + w) / (1 + w).
  QpProblem problem(1, 1);
  problem.A << 1.0;
  problem.f << -3.0;
  problem.row_upper << 1.0;
  problem.weight << 4.0;
  controllers::QpSolver solver(1, 1);
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_NEAR(solver.x()[0], 7.0 / 5.0, 1e-15);
  EXPECT_NEAR(solver.multipliers()[1], 4.0 * 0.4, 1e-14);
  EXPECT_NEAR(solver.cost(), 0.5 * 1.96 - 3.0 * 1.4 + 0.5 * 4.0 * 0.16, 1e-14);
  solver.soften_row(0, kInfinity);
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_NEAR(solver.x()[0], 1.0, 1e-15);
}

TEST(Qp, SoftRowsMayContradictEachOther) {
  // x <= -1 and x >= 1 at weights 1 and 3, and no cost of x to speak of: x near the weighted mean.
  QpProblem problem(1, 2);
  problem.H << 1e-9;
  problem.A << 1.0, 1.0;
  problem.row_upper[0] = -1.0;
  problem.row_lower[1] = 1.0;
  problem.weight << 1.0, 3.0;
  controllers::QpSolver solver(1, 2);
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_NEAR(solver.x()[0], 0.5, 1e-8);
  // Weights beyond the cap are still no contradiction.
  problem.weight << 1e30, 1e30;
  ASSERT_TRUE(problem.prepare(solver));
  EXPECT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_NEAR(solver.x()[0], 0.0, 1e-3);
}

TEST(Qp, ActiveInputsSitExactlyOnTheirLimits) {
  RandomStream random(3, "", "qp");
  QpProblem problem(12, 4);
  problem.H = random_hessian(random, 12, 4.0);
  problem.f = 1e3 * random_matrix(random, 12, 1);
  problem.A = random_matrix(random, 4, 12);
  problem.lower.setConstant(-0.1);
  problem.upper.setConstant(0.1);
  problem.row_upper.setConstant(0.3);
  controllers::QpSolver solver(12, 4);
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  int at_limit = 0;
  for (const int i : solver.active_set()) {
    if (i < 12) at_limit += std::abs(solver.x()[i]) == 0.1;
  }
  EXPECT_GE(at_limit, 4);
  EXPECT_LE(solver.x().cwiseAbs().maxCoeff(), 0.1 + 1e-9);
}

TEST(Qp, FixedVariablesAndZeroRows) {
  QpProblem problem(2, 2);
  problem.f << -1.0, -1.0;
  problem.lower << 0.25, -kInfinity;
  problem.upper << 0.25, kInfinity;
  problem.A << 0.0, 0.0, 0.0, 1.0;
  problem.row_lower << -1.0, -kInfinity;
  problem.row_upper << 1.0, 0.5;
  controllers::QpSolver solver(2, 2);
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_EQ(solver.x(), Eigen::Vector2d(0.25, 0.5));
  problem.row_lower[0] = 0.5;  // 0 >= 0.5
  EXPECT_EQ(problem.solve(solver), controllers::QpStatus::kInfeasible);
  problem.row_lower[0] = -1.0;
  EXPECT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
}

TEST(Qp, RepeatedAndDependentEqualities) {
  QpProblem problem(3, 4);
  problem.A << 1, 0, 1, 0, 1, 1, 1, 1, 2, 2, 0, 2;
  problem.row_lower << 1, 2, 3, 2;
  problem.row_upper = problem.row_lower;
  controllers::QpSolver solver(3, 4);
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_LT((solver.x() - Eigen::Vector3d(0.0, 1.0, 1.0)).norm(), 1e-14);
  EXPECT_EQ(solver.active_set().size(), 2u);
  problem.row_lower[2] = problem.row_upper[2] = 3.1;
  EXPECT_EQ(problem.solve(solver), controllers::QpStatus::kInfeasible);
}

}  // namespace
}  // namespace vinerow::test::qp_test
