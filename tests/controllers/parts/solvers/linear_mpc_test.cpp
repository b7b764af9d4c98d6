/// The linear MPC where the optimum is known: the LQR law, and limits with closed forms. Random
/// problems with everything at once against cvxopt: linear_mpc_cvxopt_check.py.

#include "controllers/parts/solvers/linear_mpc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "controllers/parts/solvers/riccati.h"
#include "tests/controllers/parts/solvers/linear_mpc_support.h"

namespace vinerow::test::linear_mpc_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(LinearMpc, WithoutLimitsIsTheLqrLaw) {
  RandomStream random(1, "", "linear_mpc_test");
  for (int i = 0; i < 50; ++i) {
    const int n = 1 + i % 7, m = 1 + i % 3, horizon = 1 + i % 12;
    controllers::LinearMpcProblem problem = random_plant(random, n, m, horizon);
    const Result<MatrixXd> P = controllers::solve_dare(problem.A, problem.B, problem.Q, problem.R);
    ASSERT_TRUE(P) << P.reason();
    problem.P = *P;
    controllers::LinearMpc mpc(problem, "test");
    MpcCall call(problem);
    for (int j = 0; j < n; ++j) call.x[j] = random.normal();
    ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
    const MatrixXd K = controllers::lqr_gain(problem.A, problem.B, problem.R, *P);
    VectorXd x = call.x;
    for (int k = 0; k < horizon; ++k) {
      const VectorXd u = -K * x, next = problem.A * x + problem.B * u;
      EXPECT_LT((mpc.inputs_ahead().col(k) - u).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT((mpc.states_ahead().col(k + 1) - next).cwiseAbs().maxCoeff(), 1e-10);
      x = next;
    }
    EXPECT_EQ(mpc.u(), mpc.inputs_ahead().col(0));
    EXPECT_EQ(mpc.iterations(), 0);
    // The cost left out is the one of the states under no input.
    double constant = 0.0;
    VectorXd free = call.x;
    for (int k = 0; k < horizon; ++k) {
      if (k > 0) constant += free.dot(problem.Q * free);
      free = problem.A * free;
    }
    constant += free.dot(problem.P * free);
    const double total = call.x.dot((*P - problem.Q) * call.x);
    EXPECT_NEAR(mpc.cost() + constant, total, 1e-9 * (1.0 + constant));
  }
}

TEST(LinearMpc, AReferenceThatTheModelCanFollowIsFollowed) {
  // r and v are a motion of the disturbed model itself: the cost is zero along it.
  RandomStream random(2, "", "linear_mpc_test");
  const controllers::LinearMpcProblem problem = random_plant(random, 4, 2, 9);
  controllers::LinearMpc mpc(problem, "test");
  MpcCall call(problem);
  for (int i = 0; i < 4; ++i) {
    call.disturbance[i] = random.normal();
    call.reference(i, 0) = random.normal();
  }
  for (int k = 0; k < 9; ++k) {
    for (int j = 0; j < 2; ++j) call.input_reference(j, k) = random.normal();
    call.reference.col(k + 1) = problem.A * call.reference.col(k) +
                                problem.B * call.input_reference.col(k) + call.disturbance;
  }
  call.x = call.reference.col(0);
  call.reference.col(0).setConstant(1e9);  // takes no part
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  EXPECT_LT((mpc.inputs_ahead() - call.input_reference).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT((mpc.states_ahead() - call.reference).rightCols(9).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(LinearMpc, PreviewActsBeforeTheStep) {
  // One integrator, a step of the reference to 4 at k = 2 of 2, with the cost p (x_2 - 4)^2 + u_0^2
  // + u_1^2: half of the way in each step, u = 4 p / (1 + 2 p).
  controllers::LinearMpcProblem problem = double_integrator(1.0, 2);
  problem.A = problem.B = MatrixXd::Ones(1, 1);
  problem.Q.setZero(1, 1);
  problem.P = MatrixXd::Constant(1, 1, 10.0);
  controllers::LinearMpc mpc(problem, "test");
  MpcCall call(problem);
  call.reference.setZero();
  call.reference.resize(1, 3);
  call.reference << 0.0, 0.0, 4.0;
  call.x = call.disturbance = VectorXd::Zero(1);
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  EXPECT_NEAR(mpc.inputs_ahead()(0, 0), 40.0 / 21.0, 1e-14);
  EXPECT_NEAR(mpc.inputs_ahead()(0, 1), 40.0 / 21.0, 1e-14);
}

/// From rest at -distance to rest at 0 in ten steps of 1 s with the least sum of u^2, |u| <= 1.
controllers::LinearMpcProblem min_effort() {
  controllers::LinearMpcProblem problem = double_integrator(1.0, 10);
  problem.input_lower.setConstant(1, -1.0);
  problem.input_upper.setConstant(1, 1.0);
  problem.terminal_rows.push_back(box(VectorXd::Zero(2), VectorXd::Zero(2)));
  return problem;
}

TEST(LinearMpc, LeastEffortBetweenTwoRestsIsAClippedLine) {
  // The optimum is odd about the middle: u_k = clip(slope (4.5 - k)), and the distance is the sum
  // of u_k (4.5 - k). Clipped twice on either side, the slope follows from
  // distance = 2 (4.5 + 3.5 + slope (2.5^2 + 1.5^2 + 0.5^2)).
  controllers::LinearMpc mpc(min_effort(), "test");
  MpcCall call(min_effort());
  for (const double slope : {0.3, 0.35, 0.39}) {
    call.x << -2.0 * (8.0 + slope * 8.75), 0.0;
    if (slope * 3.5 < 1.0) call.x[0] = -2.0 * (4.5 + slope * (3.5 * 3.5 + 8.75));
    ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
    for (int k = 0; k < 10; ++k) {
      const double u = std::clamp(slope * (4.5 - k), -1.0, 1.0);
      EXPECT_NEAR(mpc.inputs_ahead()(0, k), u, 1e-8) << slope << ' ' << k;
    }
    EXPECT_LT(mpc.states_ahead().col(10).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(LinearMpc, AtTheEdgeOfWhatCanBeReachedItIsBangBang) {
  // Full force for five steps and full brake for five cover 25 m: the time-optimal motion. A
  // centimetre less leaves a hundredth of the two middle inputs, a centimetre more is out of reach.
  controllers::LinearMpc mpc(min_effort(), "test");
  MpcCall call(min_effort());
  call.x << -24.99, 0.0;
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  for (int k = 0; k < 10; ++k) {
    const double full = k < 5 ? 1.0 : -1.0;
    EXPECT_NEAR(mpc.inputs_ahead()(0, k), k == 4 || k == 5 ? 0.99 * full : full, 1e-7) << k;
  }
  call.x << -25.01, 0.0;
  EXPECT_EQ(call.solve(mpc), controllers::QpStatus::kInfeasible);
}

TEST(LinearMpc, RatesCountFromTheInputBefore) {
  // A cheap input wants to jump to 5; it may rise by 1 and fall by 0.5 a step.
  controllers::LinearMpcProblem problem = double_integrator(1.0, 4);
  problem.rate_lower.setConstant(1, -0.5);
  problem.rate_upper.setConstant(1, 1.0);
  controllers::LinearMpc mpc(problem, "test");
  MpcCall call(problem);
  call.input_reference << 5.0, 5.0, 5.0, 5.0;
  call.input_before << 0.7;
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  const Eigen::RowVector4d up(1.7, 2.7, 3.7, 4.7);
  EXPECT_LT((mpc.inputs_ahead() - up).cwiseAbs().maxCoeff(), 1e-9);
  call.input_reference.setZero();
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  EXPECT_NEAR(mpc.u()[0], 0.2, 1e-9);
  EXPECT_NEAR(mpc.inputs_ahead()(0, 1), 0.0, 1e-9);
}

TEST(LinearMpc, NoRateLeadsBackIntoTheBounds) {
  controllers::LinearMpcProblem problem = double_integrator(1.0, 3);
  problem.input_lower.setConstant(1, -1.0);
  problem.input_upper.setConstant(1, 1.0);
  problem.rate_lower.setConstant(1, -0.5);
  problem.rate_upper.setConstant(1, 0.5);
  controllers::LinearMpc mpc(problem, "test");
  MpcCall call(problem);
  call.input_before << 1.4;
  EXPECT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  EXPECT_NEAR(mpc.u()[0], 0.9, 1e-9);
  call.input_before << 1.6;
  EXPECT_EQ(call.solve(mpc), controllers::QpStatus::kInfeasible);
}

TEST(LinearMpc, SoftLimitTradesViolationForInput) {
  // x_1 = x_0 + u, cost u^2 + 1/2 w s^2 with s = x_1 - 1: u = -w s / 2, s = (x_0 - 1) / (1 + w/2).
  controllers::LinearMpcProblem problem = double_integrator(1.0, 1);
  problem.A = problem.B = problem.R = MatrixXd::Ones(1, 1);
  problem.Q = problem.P = MatrixXd::Zero(1, 1);
  const double w = 6.0;
  controllers::MpcStateRows rows =
      box(VectorXd::Constant(1, -kInfinity), VectorXd::Constant(1, 1.0));
  rows.soft_weight.setConstant(1, w);
  problem.state_rows.push_back(rows);
  controllers::LinearMpc mpc(problem, "test");
  MpcCall call(problem);
  call.x << 3.0;
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  EXPECT_NEAR(mpc.soft_violation(), 2.0 / (1.0 + w / 2.0), 1e-12);
  EXPECT_NEAR(mpc.u()[0], -w / 2.0 * 2.0 / (1.0 + w / 2.0), 1e-12);
  call.x << 0.5;
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  EXPECT_EQ(mpc.soft_violation(), 0.0);
  EXPECT_NEAR(mpc.u()[0], 0.0, 1e-12);
}

TEST(LinearMpc, RelativeLimitsMoveWithTheReference) {
  // Only inputs have a cost, so the state would stay at zero. Its limits keep it within 0.5 of the
  // reference.
  controllers::LinearMpcProblem problem = double_integrator(1.0, 3);
  problem.A = problem.B = problem.R = MatrixXd::Ones(1, 1);
  problem.Q = problem.P = MatrixXd::Zero(1, 1);
  controllers::MpcStateRows rows = box(VectorXd::Constant(1, -0.5), VectorXd::Constant(1, 0.5));
  rows.relative = true;
  problem.state_rows.push_back(rows);
  controllers::LinearMpc mpc(problem, "test");
  MpcCall call(problem);
  call.reference << 0.0, 1.0, 2.0, 3.0;
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  // Least effort to 2.5 at the third step: 2.5 / 3 in each, which passes 1.5 at the second.
  EXPECT_LT((mpc.inputs_ahead().array() - 2.5 / 3.0).abs().maxCoeff(), 1e-9);
  call.reference << 0.0, 0.0, 3.0, 3.0;
  ASSERT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
  // x_1 <= 0.5 and x_2 >= 2.5
  EXPECT_LT((mpc.inputs_ahead() - Eigen::RowVector3d(0.5, 2.0, 0.0)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LinearMpc, ALimitThatNoInputReachesCountsAllTheSame) {
  // Euler's step: u moves v at once and x a step later, so x_1 = x_0 + T v_0 whatever u is.
  controllers::LinearMpcProblem problem = double_integrator(0.1, 5);
  problem.B << 0.0, 0.1;
  problem.P.setIdentity();
  problem.state_rows.push_back(
      box(Eigen::Vector2d(-kInfinity, -kInfinity), Eigen::Vector2d(1.0, kInfinity)));
  MpcCall call(problem);
  {
    controllers::LinearMpc mpc(problem, "test");
    call.x << 0.95, 0.45;
    EXPECT_EQ(call.solve(mpc), controllers::QpStatus::kSolved);
    call.x << 0.95, 0.55;
    EXPECT_EQ(call.solve(mpc), controllers::QpStatus::kInfeasible);
  }
  problem.state_rows[0].soft_weight.setConstant(1e4);
  problem.horizon = 1;
  controllers::LinearMpc mpc(problem, "test");
  EXPECT_EQ(mpc.solve(call.x, call.reference.leftCols(2), call.input_reference.leftCols(1),
                      call.disturbance, call.input_before),
            controllers::QpStatus::kSolved);
  EXPECT_NEAR(mpc.soft_violation(), 0.005, 1e-12);
}

}  // namespace
}  // namespace vinerow::test::linear_mpc_test
