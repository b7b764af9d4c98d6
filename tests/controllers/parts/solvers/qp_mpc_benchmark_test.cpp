/// Problems of model-predictive control by others: qpsolvers/mpc_qpbenchmark, Apache-2.0, with the
/// reference optima of an interior-point code (../shared/data/mpc_qpbenchmark). All 60 of them are
/// solved by qp_benchmark_check.py; these are the 16 that come as text.

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "tests/controllers/parts/solvers/qp_support.h"
#include "tests/support/data.h"

namespace vinerow::test::qp_mpc_benchmark_test {
namespace {

/// Blocks of "name rows columns" and the numbers row by row, after one line of comment.
std::map<std::string, Eigen::MatrixXd> read_matrices(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line, name;
  std::getline(stream, line);
  std::map<std::string, Eigen::MatrixXd> matrices;
  Eigen::Index rows = 0, columns = 0;
  while (stream >> name >> rows >> columns) {
    Eigen::MatrixXd& matrix = matrices[name];
    matrix.resize(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i) {
      for (Eigen::Index j = 0; j < columns; ++j) stream >> matrix(i, j);
    }
  }
  return matrices;
}

/// f* by problem: the fifth column.
std::map<std::string, double> read_optima(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  std::map<std::string, double> optima;
  while (std::getline(stream, line)) {
    std::istringstream fields(line);
    std::string name, field;
    std::getline(fields, name, ',');
    for (int i = 0; i < 4; ++i) std::getline(fields, field, ',');
    optima[name] = std::stod(field);
  }
  return optima;
}

void expect_solved(const std::string& name) {
  VINEROW_OUTSIDE_DATA(folder, "mpc_qpbenchmark");
  const auto matrices = read_matrices(folder / "txt" / (name + ".txt"));
  const auto optima = read_optima(folder / "reference_values.csv");
  ASSERT_EQ(optima.size(), 60u);
  const Eigen::MatrixXd &P = matrices.at("P"), &G = matrices.at("G");
  QpProblem problem(static_cast<int>(P.rows()), static_cast<int>(G.rows()));
  problem.H = P;
  problem.f = matrices.at("q");
  problem.A = G;
  problem.row_upper = matrices.at("h");
  controllers::QpSolver solver(problem.n(), problem.m());
  ASSERT_TRUE(problem.prepare(solver));
  ASSERT_EQ(problem.solve(solver), controllers::QpStatus::kSolved);
  const Eigen::VectorXd& x = solver.x();
  const double optimum = optima.at(name);
  const double reached = 0.5 * x.dot(P * x) + problem.f.dot(x);
  EXPECT_NEAR(reached, optimum, 1e-6 * std::max(1.0, std::abs(optimum)));
  EXPECT_NEAR(solver.cost(), reached, 1e-9 * std::max(1.0, std::abs(optimum)));
  EXPECT_LT((G * x - problem.row_upper).maxCoeff(), 1e-6);
  const Eigen::VectorXd z = solver.multipliers().tail(problem.m());
  EXPECT_GE(z.minCoeff(), 0.0);
  EXPECT_LT((P * x + problem.f + G.transpose() * z).cwiseAbs().maxCoeff(), 1e-6);
}

class QpMpcBenchmark : public ::testing::TestWithParam<int> {};

TEST_P(QpMpcBenchmark, Walking) {
  expect_solved("LIPMWALK" + std::to_string(GetParam()));
}
TEST_P(QpMpcBenchmark, Balancing) {
  expect_solved("WHLIPBAL" + std::to_string(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Text, QpMpcBenchmark, ::testing::Range(0, 8));

}  // namespace
}  // namespace vinerow::test::qp_mpc_benchmark_test
