/// optimal_control_files FILE: sampled models, Riccati and Lyapunov equations and MPC problems of a
/// text file, answered for judges in other languages. Matrices are given row by row. One line of
/// output for each request; exit status 2 where the file is not like that.
///   discretise n m period A B               -> ok A B
///   dare n m A B Q R                        -> ok P K | failed
///   lyapunov n A Q                          -> ok P | failed
///   mpc n m N A B Q R P  bounds [lower upper]  rates [lower upper]
///       blocks {rows relative F lower upper weight}  blocks {the same, terminal}
///       solves {x reference input_reference disturbance input_before}
///                          -> {status cost soft_violation inputs_ahead states_ahead} of each solve
/// where bounds and rates are 0 or 1, blocks and solves counts; sequences one step after the other.

#include <cstdio>
#include <string>

#include "controllers/parts/solvers/discretise.h"
#include "controllers/parts/solvers/linear_mpc.h"
#include "controllers/parts/solvers/riccati.h"
#include "tests/controllers/parts/solvers/number_reader.h"

namespace vinerow::test {
namespace {

using Eigen::MatrixXd;

void print(const MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) std::printf(" %.17g", matrix(i, j));
  }
}

void answer_discretise(NumberReader& in) {
  const int n = in.expect_int(), m = in.expect_int();
  const double period_s = in.expect();
  const MatrixXd A = in.matrix(n, n), B = in.matrix(n, m);
  const controllers::SampledModel model = controllers::discretise(A, B, period_s);
  std::printf("ok");
  print(model.A);
  print(model.B);
}

void answer_dare(NumberReader& in) {
  const int n = in.expect_int(), m = in.expect_int();
  const MatrixXd A = in.matrix(n, n), B = in.matrix(n, m), Q = in.matrix(n, n), R = in.matrix(m, m);
  const Result<MatrixXd> P = controllers::solve_dare(A, B, Q, R);
  std::printf(P ? "ok" : "failed");
  if (!P) return;
  print(*P);
  print(controllers::lqr_gain(A, B, R, *P));
}

void answer_lyapunov(NumberReader& in) {
  const int n = in.expect_int();
  const MatrixXd A = in.matrix(n, n), Q = in.matrix(n, n);
  const Result<MatrixXd> P = controllers::solve_discrete_lyapunov(A, Q);
  std::printf(P ? "ok" : "failed");
  if (P) print(*P);
}

std::vector<controllers::MpcStateRows> read_blocks(NumberReader& in, int n) {
  std::vector<controllers::MpcStateRows> blocks(static_cast<std::size_t>(in.expect_int()));
  for (controllers::MpcStateRows& block : blocks) {
    const int rows = in.expect_int();
    block.relative = in.expect_int() != 0;
    block.F = in.matrix(rows, n);
    block.lower = in.matrix(rows, 1);
    block.upper = in.matrix(rows, 1);
    block.soft_weight = in.matrix(rows, 1);
  }
  return blocks;
}

const char* word(controllers::QpStatus status) {
  if (status == controllers::QpStatus::kSolved) return "solved";
  return status == controllers::QpStatus::kInfeasible ? "infeasible" : "failed";
}

void answer_mpc(NumberReader& in) {
  const int n = in.expect_int(), m = in.expect_int();
  controllers::LinearMpcProblem problem;
  problem.horizon = in.expect_int();
  problem.A = in.matrix(n, n);
  problem.B = in.matrix(n, m);
  problem.Q = in.matrix(n, n);
  problem.R = in.matrix(m, m);
  problem.P = in.matrix(n, n);
  if (in.expect_int() != 0) {
    problem.input_lower = in.matrix(m, 1);
    problem.input_upper = in.matrix(m, 1);
  }
  if (in.expect_int() != 0) {
    problem.rate_lower = in.matrix(m, 1);
    problem.rate_upper = in.matrix(m, 1);
  }
  problem.state_rows = read_blocks(in, n);
  problem.terminal_rows = read_blocks(in, n);
  controllers::LinearMpc mpc(problem, "judge");
  for (int solves = in.expect_int(); solves > 0; --solves) {
    const Eigen::VectorXd x = in.matrix(n, 1);
    const MatrixXd reference = in.matrix(problem.horizon + 1, n).transpose();
    const MatrixXd input_reference = in.matrix(problem.horizon, m).transpose();
    const Eigen::VectorXd disturbance = in.matrix(n, 1), input_before = in.matrix(m, 1);
    const controllers::QpStatus status =
        mpc.solve(x, reference, input_reference, disturbance, input_before);
    std::printf("%s %.17g %.17g", word(status), mpc.cost(), mpc.soft_violation());
    print(mpc.inputs_ahead().transpose());
    print(mpc.states_ahead().transpose());
    if (solves > 1) std::putchar(' ');
  }
}

int answer_all(const char* file) {
  NumberReader in(file);
  for (std::string request = in.word(); !request.empty(); request = in.word()) {
    if (request == "discretise") {
      answer_discretise(in);
    } else if (request == "dare") {
      answer_dare(in);
    } else if (request == "lyapunov") {
      answer_lyapunov(in);
    } else if (request == "mpc") {
      answer_mpc(in);
    } else {
      std::fprintf(stderr, "unknown request '%s'\n", request.c_str());
      return 2;
    }
    std::putchar('\n');
  }
  return 0;
}

}  // namespace
}  // namespace vinerow::test

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: optimal_control_files FILE\n", stderr);
    return 2;
  }
  return vinerow::test::answer_all(arguments[1]);
}
