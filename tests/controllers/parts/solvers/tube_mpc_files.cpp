/// tube_mpc_files FILE: sets and optima of tube MPC for the problems of a text file, for judges in
/// other languages. Matrices are given row by row. Each request is
///   tube n m g N law shape soft_weight A B E K gust state_limit input_limit Q R solves {x}
/// with law 0 (z_0 free) or 1 (z_0 = x), shape 0 (box) or 1 (invariant). Each answer is one line:
///   ok state_limit input_limit rows {tube row} rows {terminal row}
///      {status cost violation z_0 u c_0 .. c_{N-1}} of each solve, or: failed

#include <cstdio>
#include <string>

#include "controllers/parts/solvers/tube_mpc.h"
#include "tests/controllers/parts/solvers/number_reader.h"

namespace vinerow::test {
namespace {

using Eigen::MatrixXd;

void print(const MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) std::printf(" %.17g", matrix(i, j));
  }
}

void print_rows(const MatrixXd& rows) {
  std::printf(" %d", static_cast<int>(rows.rows()));
  print(rows);
}

void answer(NumberReader& in) {
  const int n = in.expect_int(), m = in.expect_int(), g = in.expect_int();
  controllers::TubeCost cost;
  cost.horizon = in.expect_int();
  controllers::TubeMpcSettings settings;
  settings.law =
      in.expect_int() == 0 ? controllers::TubeLaw::kTube : controllers::TubeLaw::kFixedStart;
  const controllers::TubeShape shape =
      in.expect_int() == 0 ? controllers::TubeShape::kBox : controllers::TubeShape::kInvariant;
  settings.soft_weight = in.expect();
  controllers::TubeModel model;
  model.A = in.matrix(n, n);
  model.B = in.matrix(n, m);
  model.E = in.matrix(n, g);
  model.K = in.matrix(m, n);
  model.gust = in.matrix(g, 1);
  model.state_limit = in.matrix(n, 1);
  model.input_limit = in.matrix(m, 1);
  cost.Q = in.matrix(n, n);
  cost.R = in.matrix(m, m);
  const int solves = in.expect_int();
  const MatrixXd states = in.matrix(solves, n);
  const Result<controllers::TubeSets> sets = controllers::make_tube_sets(model, shape);
  if (!sets) {
    std::printf("failed\n");
    return;
  }
  std::printf("ok");
  print(sets->state_limit);
  print(sets->input_limit);
  print_rows(sets->tube_rows);
  print_rows(sets->terminal_rows);
  controllers::TubeMpc mpc(model, *sets, cost, settings, "file");
  for (int i = 0; i < solves; ++i) {
    const controllers::QpStatus status = mpc.solve(states.row(i).transpose());
    std::printf(" %s %.17g %.17g", status == controllers::QpStatus::kSolved ? "solved" : "failed",
                mpc.cost(), mpc.soft_violation());
    print(mpc.z0());
    print(mpc.u());
    print(mpc.corrections());
  }
  std::putchar('\n');
}

}  // namespace
}  // namespace vinerow::test

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: tube_mpc_files FILE\n", stderr);
    return 2;
  }
  vinerow::test::NumberReader numbers(arguments[1]);
  for (std::string word = numbers.word(); !word.empty(); word = numbers.word()) {
    if (word != "tube") {
      std::fprintf(stderr, "unknown request '%s'\n", word.c_str());
      return 2;
    }
    vinerow::test::answer(numbers);
  }
  return 0;
}
