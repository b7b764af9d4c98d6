/// Random programmes. A strictly convex programme has one optimum, which its optimality conditions
/// prove: qp_residuals() judges them with the problem's own matrices.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/controllers/parts/solvers/qp_support.h"

namespace vinerow::test::qp_random_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_all_optimal(const char* name, int count, const QpRandomKind& kind) {
  double worst_violation = 0.0;
  int max_iterations = 0;
  for (int run = 0; run < count; ++run) {
    RandomStream random(static_cast<std::uint64_t>(run), "", name);
    const QpProblem problem = random_feasible_qp(random, kind);
    controllers::QpSolver solver(problem.n(), problem.m());
    ASSERT_TRUE(problem.prepare(solver));
    ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved) << name << ' ' << run;
    const QpResiduals residuals = qp_residuals(problem, solver);
    ASSERT_LT(residuals.largest(), 1e-8) << name << ' ' << run;
    worst_violation = std::max(worst_violation, residuals.primal);
    max_iterations = std::max(max_iterations, solver.iterations());
  }
  EXPECT_LT(worst_violation, 1.1e-9) << "QpSettings::tolerance and a little rounding";
  EXPECT_LT(max_iterations, 500);
}

TEST(QpRandom, DegenerateProblems) {
  expect_all_optimal("degenerate", 1500, {});
}

TEST(QpRandom, SmallProblemsWithManyRows) {
  QpRandomKind kind;
  kind.max_variables = 4;
  kind.max_rows = 20;
  expect_all_optimal("small", 3000, kind);
}

TEST(QpRandom, LargeProblems) {
  QpRandomKind kind;
  kind.max_variables = 80;
  kind.max_rows = 240;
  expect_all_optimal("large", 40, kind);
}

TEST(QpRandom, IllConditionedHessian) {
  QpRandomKind kind;
  kind.log10_condition = 8.0;
  expect_all_optimal("condition", 500, kind);
}

TEST(QpRandom, RowsOfAllLengths) {
  QpRandomKind kind;
  kind.log10_length = 3.0;
  expect_all_optimal("length", 500, kind);
  kind.log10_condition = 8.0;
  expect_all_optimal("length and condition", 500, kind);
}

/// Rows whose combination with positive factors is 0 x <= bound: by Farkas' lemma no x satisfies
/// them if the bound is negative, and some does if it is not.
QpProblem contradictory_qp(RandomStream& random, double bound) {
  QpRandomKind kind;
  kind.equalities = false;
  kind.max_rows = 40;
  QpProblem problem = random_feasible_qp(random, kind);
  const int n = problem.n();
  const int involved = 2 + static_cast<int>(random.uniform() * n);
  const int m = problem.m();
  QpProblem result(n, m + involved);
  result.H = problem.H;
  result.f = problem.f;
  // The other rows hold in a wide neighbourhood, so that they do not decide.
  result.A.topRows(m) = problem.A;
  for (int r = 0; r < m; ++r) result.row_upper[r] = 1e3;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(n);
  double sum_of_limits = 0.0;
  for (int i = 0; i < involved; ++i) {
    const int r = m + i;
    const double limit = random.uniform(-1.0, 1.0);
    const bool last = i == involved - 1;
    const double factor = last ? 1.0 : random.uniform(0.5, 2.0);
    if (last) {
      result.A.row(r) = -sum;
    } else {
      result.A.row(r) = random_matrix(random, 1, n);
    }
    sum += factor * result.A.row(r);
    const double here = last ? bound - sum_of_limits : limit;
    sum_of_limits += factor * here;
    // Some as lower limits of the reversed row.
    if (random.uniform() < 0.5) {
      result.A.row(r) *= -1.0;
      result.row_lower[r] = -here;
    } else {
      result.row_upper[r] = here;
    }
  }
  return result;
}

TEST(QpRandom, FarkasCertificatesDecideFeasibility) {
  for (int run = 0; run < 500; ++run) {
    for (const double bound : {-1.0, -1e-5, 1e-5}) {
      RandomStream random(static_cast<std::uint64_t>(run), "", "farkas");
      const QpProblem problem = contradictory_qp(random, bound);
      controllers::QpSolver solver(problem.n(), problem.m());
      ASSERT_TRUE(problem.prepare(solver));
      ASSERT_EQ(problem.solve(solver),
                bound < 0.0 ? controllers::QpStatus::kInfeasible : controllers::QpStatus::kSolved)
          << run << ' ' << bound;
    }
  }
}

TEST(QpRandom, SoftRowsAreSlackVariables) {
  for (int run = 0; run < 300; ++run) {
    RandomStream random(static_cast<std::uint64_t>(run), "", "soft");
    QpProblem problem = random_feasible_qp(random, {});
    const int n = problem.n(), m = problem.m();
    if (m == 0) continue;
    std::vector<int> soft;
    for (int r = 0; r < m; ++r) {
      if (random.uniform() < 0.5) soft.push_back(r);
    }
    const auto slacks = static_cast<int>(soft.size());
    QpProblem explicit_slacks(n + slacks, m);
    explicit_slacks.H.topLeftCorner(n, n) = problem.H;
    explicit_slacks.f.head(n) = problem.f;
    explicit_slacks.A.leftCols(n) = problem.A;
    for (int i = 0; i < slacks; ++i) {
      const int r = soft[static_cast<std::size_t>(i)];
      problem.weight[r] = std::pow(10.0, random.uniform(-2.0, 4.0));
      problem.row_upper[r] -= 0.5;  // what was feasible need not be any more
      problem.row_lower[r] -= 0.5;
      explicit_slacks.H(n + i, n + i) = problem.weight[r];
      explicit_slacks.A(r, n + i) = -1.0;
    }
    explicit_slacks.lower.head(n) = problem.lower;
    explicit_slacks.upper.head(n) = problem.upper;
    explicit_slacks.row_lower = problem.row_lower;
    explicit_slacks.row_upper = problem.row_upper;
    controllers::QpSolver solver(n, m), larger(n + slacks, m);
    ASSERT_TRUE(problem.prepare(solver) && explicit_slacks.prepare(larger));
    ASSERT_EQ(explicit_slacks.solve(larger), controllers::QpStatus::kSolved) << run;
    ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved) << run;
    const double size = 1.0 + larger.x().norm();
    EXPECT_LT((solver.x() - larger.x().head(n)).norm(), 1e-8 * size) << run;
    EXPECT_NEAR(solver.cost(), larger.cost(), 1e-9 * (1.0 + std::abs(larger.cost()))) << run;
    EXPECT_LT(qp_residuals(problem, solver).largest(), 1e-8) << run;
  }
}

TEST(QpRandom, WarmStartEndsWhereAColdStartEnds) {
  int warm_iterations = 0, cold_iterations = 0;
  for (int run = 0; run < 60; ++run) {
    RandomStream random(static_cast<std::uint64_t>(run), "", "warm");
    QpProblem problem = random_feasible_qp(random, {});
    const int n = problem.n(), m = problem.m();
    controllers::QpSolver warm(n, m);
    ASSERT_TRUE(problem.prepare(warm));
    for (int step = 0; step < 40; ++step) {
      problem.f += 0.1 * problem.f.norm() * random_matrix(random, n, 1);
      // Limits that appear and vanish, sides that change, an equality that becomes a band.
      if (step % 5 == 4 && m > 0) {
        const auto r = static_cast<Eigen::Index>(random.uniform() * m);
        if (problem.row_lower[r] == problem.row_upper[r]) {
          problem.row_upper[r] += 0.1;
        } else if (std::isfinite(problem.row_upper[r]) && std::isfinite(problem.row_lower[r])) {
          problem.row_upper[r] = kInfinity;
        }
      }
      if (step % 10 == 7) {
        problem.H = random_hessian(random, n, 2.0);
        ASSERT_TRUE(warm.set_hessian(problem.H));
      }
      controllers::QpSolver cold(n, m);
      ASSERT_TRUE(problem.prepare(cold));
      ASSERT_EQ(problem.solve(warm), controllers::QpStatus::kSolved) << run << ' ' << step;
      ASSERT_EQ(problem.solve(cold), controllers::QpStatus::kSolved) << run << ' ' << step;
      ASSERT_LT((warm.x() - cold.x()).norm(), 1e-8 * (1.0 + cold.x().norm())) << run << ' ' << step;
      ASSERT_LT(qp_residuals(problem, warm).largest(), 1e-8) << run << ' ' << step;
      warm_iterations += warm.iterations();
      cold_iterations += cold.iterations();
    }
  }
  EXPECT_LT(warm_iterations, cold_iterations / 2);
}

TEST(QpRandom, RepeatedProblemTakesNoIteration) {
  for (int run = 0; run < 100; ++run) {
    RandomStream random(static_cast<std::uint64_t>(run), "", "repeat");
    const QpProblem problem = random_feasible_qp(random, {});
    controllers::QpSolver solver(problem.n(), problem.m());
    ASSERT_TRUE(problem.prepare(solver));
    ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
    const Eigen::VectorXd x = solver.x();
    ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
    EXPECT_EQ(solver.iterations(), 0) << run;
    EXPECT_LT((solver.x() - x).norm(), 1e-10 * (1.0 + x.norm())) << run;
  }
}

/// Rounding of thousands of changes of the active set must not pile up in its factors.
TEST(QpRandom, LongWarmRunKeepsItsPrecision) {
  RandomStream random(7, "", "long");
  QpProblem problem(30, 60);
  problem.H = random_hessian(random, 30, 3.0);
  problem.A = random_matrix(random, 60, 30);
  problem.row_upper.setConstant(1.0);
  problem.row_lower.setConstant(-1.0);
  problem.lower.setConstant(-0.3);
  problem.upper.setConstant(0.3);
  controllers::QpSolver solver(30, 60);
  ASSERT_TRUE(problem.prepare(solver));
  long iterations = 0;
  for (int step = 0; step < 3000; ++step) {
    problem.f = 50.0 * random_matrix(random, 30, 1);
    ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
    iterations += solver.iterations();
    const QpResiduals residuals = qp_residuals(problem, solver);
    ASSERT_LT(residuals.stationarity, 1e-12) << step;
    ASSERT_LT(residuals.complementarity, 1e-10) << step;
  }
  EXPECT_GT(iterations, 30000);
}

}  // namespace
}  // namespace vinerow::test::qp_random_test
