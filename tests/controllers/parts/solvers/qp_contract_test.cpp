/// What QpSolver promises besides the optimum: statuses, no heap, repeatable results.

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "controllers/parts/solvers/qp.h"
#include "tests/controllers/parts/solvers/qp_support.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::qp_contract_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(QpContract, SaysWhatIsWrongWithTheProblem) {
  QpProblem problem(2, 1);
  problem.A << 1.0, 1.0;
  controllers::QpSolver solver(2, 1);
  EXPECT_EQ(problem.solve(solver), controllers::QpStatus::kNotConvex) << "no Hessian yet";
  EXPECT_FALSE(solver.set_hessian((Eigen::Matrix2d() << 1.0, 2.0, 2.0, 1.0).finished()));
  EXPECT_EQ(problem.solve(solver), controllers::QpStatus::kNotConvex);
  EXPECT_FALSE(solver.set_hessian((Eigen::Matrix2d() << 1.0, 1.0, 1.0, 1.0).finished()));
  EXPECT_FALSE(solver.set_hessian((Eigen::Matrix2d() << 1.0, 0.0, 0.0, kNaN).finished()));
  EXPECT_FALSE(solver.set_hessian((Eigen::Matrix2d() << 1.0, 0.0, 0.0, kInfinity).finished()));
  EXPECT_FALSE(solver.set_hessian(Eigen::Matrix2d::Zero()));
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);

  const auto status_with = [&](auto&& change) {
    QpProblem changed = problem;
    change(changed);
    changed.prepare(solver);
    const controllers::QpStatus status = changed.solve(solver);
    problem.prepare(solver);
    EXPECT_EQ(problem.solve(solver), controllers::QpStatus::kSolved) << "recovers";
    return status;
  };
  EXPECT_EQ(status_with([](QpProblem& p) { p.f[1] = kNaN; }), controllers::QpStatus::kInvalidInput);
  EXPECT_EQ(status_with([](QpProblem& p) { p.f[1] = kInfinity; }),
            controllers::QpStatus::kInvalidInput);
  EXPECT_EQ(status_with([](QpProblem& p) { p.A(0, 1) = kNaN; }),
            controllers::QpStatus::kInvalidInput);
  EXPECT_EQ(status_with([](QpProblem& p) { p.A(0, 1) = kInfinity; }),
            controllers::QpStatus::kInvalidInput);
  EXPECT_EQ(status_with([](QpProblem& p) { p.lower[0] = kNaN; }),
            controllers::QpStatus::kInvalidInput);
  EXPECT_EQ(status_with([](QpProblem& p) { p.row_upper[0] = kNaN; }),
            controllers::QpStatus::kInvalidInput);
  EXPECT_EQ(status_with([](QpProblem& p) { p.lower[0] = kInfinity; }),
            controllers::QpStatus::kInfeasible);
  EXPECT_EQ(status_with([](QpProblem& p) { p.upper[0] = -kInfinity; }),
            controllers::QpStatus::kInfeasible);
  EXPECT_EQ(status_with([](QpProblem& p) {
              p.lower[1] = 1.0;
              p.upper[1] = 0.999;
            }),
            controllers::QpStatus::kInfeasible);
  EXPECT_EQ(status_with([](QpProblem& p) {
              p.upper.setConstant(1.0);
              p.row_lower[0] = 2.001;
            }),
            controllers::QpStatus::kInfeasible);
  EXPECT_EQ(status_with([](QpProblem& p) { p.f.setConstant(1e308); }),
            controllers::QpStatus::kInvalidInput)
      << "the point overflows";
  EXPECT_STREQ(controllers::to_string(controllers::QpStatus::kInfeasible), "infeasible");
}

TEST(QpContract, StopsAtItsIterationLimit) {
  RandomStream random(4, "", "qp");
  QpProblem problem(10, 0);
  problem.H = random_hessian(random, 10, 1.0);
  problem.f = 100.0 * random_matrix(random, 10, 1);
  problem.lower.setConstant(-1.0);
  problem.upper.setConstant(1.0);
  controllers::QpSettings settings;
  settings.max_iterations = 3;
  controllers::QpSolver hurried(10, 0, settings), solver(10, 0);
  ASSERT_TRUE(problem.prepare(hurried) && problem.prepare(solver));
  EXPECT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_GT(solver.iterations(), 3);
  EXPECT_EQ(problem.solve(hurried), controllers::QpStatus::kIterationLimit);
}

TEST(QpContract, AllocatesNothingAfterTheConstructor) {
  RandomStream random(5, "", "qp");
  QpRandomKind kind;
  for (int run = 0; run < 50; ++run) {
    const QpProblem problem = random_feasible_qp(random, kind);
    QpProblem other = problem;
    other.H = random_hessian(random, problem.n(), 2.0);
    other.A = random_matrix(random, problem.m(), problem.n());
    controllers::QpSolver solver(problem.n(), problem.m());
    const AllocationCounter counter;
    problem.prepare(solver);
    problem.solve(solver);
    if (problem.m() > 0) solver.soften_row(0, 10.0);
    problem.solve(solver);
    other.prepare(solver);  // most of these are infeasible
    other.solve(solver);
    solver.cold_start();
    problem.solve(solver);
    EXPECT_EQ(counter.count(), 0u);
  }
  // The size of an MPC of a quadrotor: Eigen's products must not take work space either.
  QpProblem large(80, 240);
  large.H = random_hessian(random, 80, 2.0);
  large.f = 10.0 * random_matrix(random, 80, 1);
  large.A = random_matrix(random, 240, 80);
  large.row_upper.setConstant(1.0);
  large.upper.setConstant(0.5);
  controllers::QpSolver solver(80, 240);
  const AllocationCounter counter;
  large.prepare(solver);
  EXPECT_EQ(large.solve(solver), controllers::QpStatus::kSolved);
  EXPECT_GT(solver.active_set().size(), 10u);
  EXPECT_EQ(counter.count(), 0u);
}

TEST(QpContract, SameCallsGiveTheSameBitsAndAColdStartForgets) {
  RandomStream random(6, "", "qp");
  for (int run = 0; run < 20; ++run) {
    const QpProblem problem = random_feasible_qp(random, {});
    QpProblem next = problem;
    next.f = random_matrix(random, problem.n(), 1);
    controllers::QpSolver first(problem.n(), problem.m()), second(problem.n(), problem.m());
    for (controllers::QpSolver* solver : {&first, &second}) {
      problem.prepare(*solver);
      problem.solve(*solver);
      next.solve(*solver);
    }
    EXPECT_EQ(first.x(), second.x());
    EXPECT_EQ(first.multipliers(), second.multipliers());
    EXPECT_EQ(first.iterations(), second.iterations());
    controllers::QpSolver fresh(problem.n(), problem.m());
    problem.prepare(fresh);
    next.solve(fresh);
    first.cold_start();
    next.solve(first);
    EXPECT_EQ(first.x(), fresh.x());
    EXPECT_EQ(first.iterations(), fresh.iterations());
  }
}

TEST(QpContract, MovesKeepTheProblem) {
  QpProblem problem(1, 0);
  problem.f << -1.0;
  controllers::QpSolver solver(1, 0);
  ASSERT_TRUE(problem.prepare(solver));
  controllers::QpSolver moved(std::move(solver));
  ASSERT_EQ(problem.solve(moved), controllers::QpStatus::kSolved);
  controllers::QpSolver assigned(2, 3);
  assigned = std::move(moved);
  EXPECT_EQ(assigned.variables(), 1);
  EXPECT_EQ(assigned.rows(), 0);
  EXPECT_EQ(assigned.x()[0], 1.0);
}

}  // namespace
}  // namespace vinerow::test::qp_contract_test
