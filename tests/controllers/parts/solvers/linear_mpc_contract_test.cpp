/// What the linear MPC promises beside the optimum: no heap, same bits, sense after bad input,
/// clear refusals.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "controllers/parts/solvers/linear_mpc.h"
#include "engine/core/error.h"
#include "tests/controllers/parts/solvers/linear_mpc_support.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::linear_mpc_contract_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Every kind of limit at once.
controllers::LinearMpcProblem busy_problem() {
  RandomStream random(5, "", "linear_mpc_contract_test");
  controllers::LinearMpcProblem problem = random_plant(random, 5, 2, 8);
  problem.input_lower.setConstant(2, -0.7);
  problem.input_upper.setConstant(2, 0.5);
  problem.rate_lower.setConstant(2, -0.4);
  problem.rate_upper.setConstant(2, 0.4);
  controllers::MpcStateRows rows = box(VectorXd::Constant(5, -1.0), VectorXd::Constant(5, 1.0));
  rows.soft_weight.setConstant(5, 100.0);
  problem.state_rows.push_back(rows);
  rows.relative = true;
  problem.terminal_rows.push_back(rows);
  return problem;
}

/// A closed loop pushed about, in which limits come and go. @returns all inputs
std::vector<double> run_loop(controllers::LinearMpc& mpc,
                             const controllers::LinearMpcProblem& problem, int steps) {
  RandomStream random(6, "", "linear_mpc_contract_test");
  MpcCall call(problem);
  std::vector<double> inputs;
  int changes = 0;
  for (int step = 0; step < steps; ++step) {
    if (step % 20 == 0) call.reference.row(0).setConstant(random.uniform(-6.0, 6.0));
    call.solve(mpc);
    call.input_before = mpc.u();
    for (const double u : mpc.u()) inputs.push_back(u);
    changes += mpc.iterations();
    call.x = problem.A * call.x + problem.B * mpc.u();
    for (double& x : call.x) x += 0.1 * random.normal();
  }
  EXPECT_GT(changes, steps / 2);
  return inputs;
}

TEST(LinearMpcContract, SolvesWithoutHeapWhateverComes) {
  const controllers::LinearMpcProblem problem = busy_problem();
  controllers::LinearMpc mpc(problem, "test");
  MpcCall good(problem), far(problem), bad(problem);
  good.x.setConstant(0.8);
  far.x.setConstant(1e3);
  bad.x[2] = kNan;
  const AllocationCounter counter;
  for (const MpcCall* call : {&good, &far, &bad, &good}) call->solve(mpc);
  mpc.cold_start();
  good.solve(mpc);
  EXPECT_EQ(counter.count(), 0u);
}

TEST(LinearMpcContract, SameCallsSameBits) {
  const controllers::LinearMpcProblem problem = busy_problem();
  controllers::LinearMpc first(problem, "test"), second(problem, "test");
  const std::vector<double> once = run_loop(first, problem, 200);
  EXPECT_EQ(once, run_loop(second, problem, 200));
  first.cold_start();
  EXPECT_EQ(once, run_loop(first, problem, 200));
}

TEST(LinearMpcContract, WarmAndColdAgree) {
  const controllers::LinearMpcProblem problem = busy_problem();
  controllers::LinearMpc warm(problem, "test"), cold(problem, "test");
  RandomStream random(7, "", "linear_mpc_contract_test");
  MpcCall call(problem);
  for (int step = 0; step < 200; ++step) {
    if (step % 20 == 0) call.reference.row(1).setConstant(random.uniform(-2.0, 2.0));
    cold.cold_start();
    ASSERT_EQ(call.solve(warm), controllers::QpStatus::kSolved);
    ASSERT_EQ(call.solve(cold), controllers::QpStatus::kSolved);
    EXPECT_LT((warm.inputs_ahead() - cold.inputs_ahead()).cwiseAbs().maxCoeff(), 1e-9);
    call.input_before = warm.u();
    call.x = problem.A * call.x + problem.B * warm.u();
    for (double& x : call.x) x += 0.1 * random.normal();
  }
}

/// |x| <= 1 hard, |u| <= 1, on a slow double integrator.
controllers::LinearMpcProblem walled() {
  controllers::LinearMpcProblem problem = double_integrator(0.1, 6);
  problem.Q.setIdentity();
  problem.P.setIdentity();
  problem.R *= 0.01;
  problem.input_lower.setConstant(1, -1.0);
  problem.input_upper.setConstant(1, 1.0);
  problem.state_rows.push_back(
      box(Eigen::Vector2d(-1.0, -kInfinity), Eigen::Vector2d(1.0, kInfinity)));
  return problem;
}

TEST(LinearMpcContract, OutsideHardLimitsTheLastInputsMoveUp) {
  const controllers::LinearMpcProblem problem = walled();
  controllers::LinearMpc mpc(problem, "test");
  MpcCall call(problem);
  call.x << 0.8, 0.0;
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  MatrixXd expected = mpc.inputs_ahead();
  ASSERT_GT((expected.rightCols(5) - expected.leftCols(5)).norm(), 0.1);  // not all the same
  call.x << 1.5, 0.0;
  for (int failure = 1; failure <= 8; ++failure) {
    ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kInfeasible);
    const MatrixXd moved = expected.rightCols(5);
    expected.leftCols(5) = moved;
    EXPECT_EQ(mpc.inputs_ahead(), expected) << failure;
    EXPECT_EQ(mpc.states_ahead().col(0), call.x);
    EXPECT_EQ(mpc.states_ahead()(1, 1), 0.1 * expected(0, 0));
  }
  // The end of the sequence is held.
  EXPECT_EQ(expected.minCoeff(), expected.maxCoeff());
  call.x << 0.8, 0.0;
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  controllers::LinearMpc fresh(problem, "test");
  ASSERT_EQ(call.solve(fresh), controllers::QpStatus::kSolved);
  EXPECT_EQ(mpc.inputs_ahead(), fresh.inputs_ahead());
}

TEST(LinearMpcContract, SoftLimitsBringAStateBackThatIsOutside) {
  controllers::LinearMpcProblem problem = walled();
  problem.state_rows[0].soft_weight.setConstant(1e5);
  controllers::LinearMpc mpc(problem, "test");
  MpcCall call(problem);
  call.x << 1.5, 0.5;
  call.reference.row(0).setConstant(0.99);
  double last = kInfinity;
  for (int step = 0; step < 200; ++step) {
    ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
    // Once the speed has turned, the violation only falls.
    if (step > 8) {
      EXPECT_LE(mpc.soft_violation(), last);
    }
    last = mpc.soft_violation();
    call.x = problem.A * call.x + problem.B * mpc.u();
  }
  EXPECT_LT(last, 1e-4);
  EXPECT_NEAR(call.x[0], 0.99, 0.02);
}

TEST(LinearMpcContract, NumbersThatAreNoneNeverReachTheInput) {
  const controllers::LinearMpcProblem problem = walled();
  for (const double wrong : {kNan, kInfinity, -kInfinity}) {
    for (int place = 0; place < 6; ++place) {
      controllers::LinearMpc mpc(problem, "test");
      MpcCall call(problem);
      call.x << 0.8, 0.0;
      ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
      const MatrixXd inputs = mpc.inputs_ahead(), states = mpc.states_ahead();
      if (place == 0) call.x[1] = wrong;
      if (place == 1) call.reference(1, 6) = wrong;
      if (place == 2) call.input_reference(0, 3) = wrong;
      if (place == 3) call.disturbance[0] = wrong;
      if (place == 4) call.input_before[0] = wrong;
      if (place == 5) call.reference(0, 0) = wrong;
      EXPECT_EQ(call.solve(mpc), controllers::QpStatus::kInvalidInput) << place;
      EXPECT_EQ(mpc.inputs_ahead().leftCols(5), inputs.rightCols(5));
      EXPECT_TRUE(mpc.states_ahead().allFinite());
      EXPECT_TRUE(std::isfinite(mpc.soft_violation()));
      if (place == 0 || place == 3) {
        EXPECT_EQ(mpc.states_ahead().leftCols(6), states.rightCols(6));
      }
    }
  }
}

TEST(LinearMpcContract, BeforeTheFirstSolutionInputsAreZeroWithinBounds) {
  controllers::LinearMpcProblem problem = walled();
  problem.input_lower.setConstant(1, 0.25);
  controllers::LinearMpc mpc(problem, "test");
  EXPECT_EQ(mpc.u()[0], 0.25);
  MpcCall call(problem);
  call.x << 5.0, kNan;
  EXPECT_EQ(call.solve(mpc), controllers::QpStatus::kInvalidInput);
  EXPECT_EQ(mpc.u()[0], 0.25);
}

TEST(LinearMpcContract, TheIterationLimitIsReported) {
  const controllers::LinearMpcProblem problem = busy_problem();
  controllers::QpSettings settings;
  settings.max_iterations = 2;
  controllers::LinearMpc mpc(problem, "test", settings);
  MpcCall call(problem);
  call.x.setConstant(3.0);
  EXPECT_EQ(call.solve(mpc), controllers::QpStatus::kIterationLimit);
  EXPECT_TRUE(mpc.inputs_ahead().isZero());
}

std::string refusal(const controllers::LinearMpcProblem& problem) {
  try {
    const controllers::LinearMpc mpc(problem, "drone.controller");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LinearMpcContract, RefusesShapesThatDoNotFit) {
  const auto with = [](auto change) {
    controllers::LinearMpcProblem problem = walled();
    change(problem);
    return refusal(problem);
  };
  using Problem = controllers::LinearMpcProblem;
  EXPECT_EQ(with([](Problem&) {}), "accepted");
  EXPECT_EQ(with([](Problem& p) { p.A.resize(0, 0); }), "drone.controller: A has no rows");
  EXPECT_EQ(with([](Problem& p) { p.A.setZero(2, 3); }),
            "drone.controller: A is 2 x 3, must be 2 x 2");
  EXPECT_EQ(with([](Problem& p) { p.B.setZero(3, 1); }),
            "drone.controller: B is 3 x 1, must be 2 x 1");
  EXPECT_EQ(with([](Problem& p) { p.B.resize(2, 0); }), "drone.controller: B has no columns");
  EXPECT_EQ(with([](Problem& p) { p.Q.setZero(1, 2); }),
            "drone.controller: Q is 1 x 2, must be 2 x 2");
  EXPECT_EQ(with([](Problem& p) { p.Q(0, 1) = 0.5; }), "drone.controller: Q is not symmetric");
  EXPECT_EQ(with([](Problem& p) { p.P(0, 0) = kNan; }),
            "drone.controller: P contains a number that is not finite");
  EXPECT_EQ(with([](Problem& p) { p.R.setZero(2, 2); }),
            "drone.controller: R is 2 x 2, must be 1 x 1");
  EXPECT_EQ(with([](Problem& p) { p.R(0, 0) = -5.0; }),
            "drone.controller: the condensed Hessian of Q, R and P is not positive definite");
  EXPECT_EQ(with([](Problem& p) { p.horizon = 0; }), "drone.controller: horizon = 0, must be >= 1");
  EXPECT_EQ(with([](Problem& p) { p.input_lower.resize(0); }),
            "drone.controller: input lower has 0 numbers, must have 1");
  EXPECT_EQ(with([](Problem& p) { p.input_lower[0] = 2.0; }),
            "drone.controller: input 0: lower = 2, upper = 1, must be lower <= upper");
  EXPECT_EQ(with([](Problem& p) { p.rate_upper.setZero(2); }),
            "drone.controller: rate lower has 0 numbers, must have 1");
}

TEST(LinearMpcContract, RefusesRowsThatDoNotFit) {
  const auto with = [](auto change) {
    controllers::LinearMpcProblem problem = walled();
    problem.terminal_rows.push_back(problem.state_rows[0]);
    change(problem.terminal_rows[0]);
    return refusal(problem);
  };
  EXPECT_EQ(with([](controllers::MpcStateRows&) {}), "accepted");
  EXPECT_EQ(with([](controllers::MpcStateRows& rows) { rows = controllers::MpcStateRows(); }),
            "accepted");
  EXPECT_EQ(with([](controllers::MpcStateRows& rows) { rows.soft_weight.resize(0); }), "accepted");
  EXPECT_EQ(with([](controllers::MpcStateRows& rows) { rows.F.setZero(2, 3); }),
            "drone.controller: terminal_rows 0: F is 2 x 3, must be 2 x 2");
  EXPECT_EQ(with([](controllers::MpcStateRows& rows) { rows.upper.setZero(1); }),
            "drone.controller: terminal_rows 0: upper has 1 numbers, must have 2");
  EXPECT_EQ(
      with([](controllers::MpcStateRows& rows) { rows.lower[1] = kNan; }),
      "drone.controller: terminal_rows 0: 1: lower = nan, upper = inf, must be lower <= upper");
  EXPECT_EQ(with([](controllers::MpcStateRows& rows) { rows.soft_weight.setZero(2); }),
            "drone.controller: terminal_rows 0: soft_weight 0 = 0, must be > 0");
  EXPECT_EQ(with([](controllers::MpcStateRows& rows) { rows.soft_weight.setOnes(3); }),
            "drone.controller: terminal_rows 0: soft_weight has 3 numbers, must have 2 or none");
}

}  // namespace
}  // namespace vinerow::test::linear_mpc_contract_test
