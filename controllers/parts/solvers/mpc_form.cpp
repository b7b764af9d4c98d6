#include "controllers/parts/solvers/mpc_form.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/constants.h"
#include "engine/core/error.h"

namespace vinerow::controllers::mpc {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A row of the condensed problem shorter than this share of its terms is rounding.
constexpr double kRoundingRow = 1e-13;

class Checker {
 public:
  explicit Checker(const std::string& who) : who_(who) {}

  void matrix(const std::string& name, const MatrixXd& M, Index rows, Index columns) const {
    if (M.rows() != rows || M.cols() != columns) {
      fail(fmt::format("{} is {} x {}, must be {} x {}", name, M.rows(), M.cols(), rows, columns));
    }
    if (!M.allFinite()) fail(name + " contains a number that is not finite");
  }

  void weight(const std::string& name, const MatrixXd& M, Index size) const {
    matrix(name, M, size, size);
    if (!M.isApprox(M.transpose(), 1e-9)) fail(name + " is not symmetric");
  }

  /// Limits may be infinite. @param optional  both may be empty: no limits
  void limits(const std::string& name, const VectorXd& lower, const VectorXd& upper, Index size,
              bool optional) const {
    if (optional && lower.size() == 0 && upper.size() == 0) return;
    for (const VectorXd* limit : {&lower, &upper}) {
      if (limit->size() == size) continue;
      fail(fmt::format("{} {} has {} numbers, must have {}", name,
                       limit == &lower ? "lower" : "upper", limit->size(), size));
    }
    for (Index i = 0; i < size; ++i) {
      if (lower[i] <= upper[i]) continue;
      fail(fmt::format("{} {}: lower = {:g}, upper = {:g}, must be lower <= upper", name, i,
                       lower[i], upper[i]));
    }
  }

  void rows(const std::string& name, const MpcStateRows& block, Index states) const {
    if (block.F.rows() == 0 && block.lower.size() == 0) return;
    matrix(name + ": F", block.F, block.F.rows(), states);
    limits(name + ":", block.lower, block.upper, block.F.rows(), false);
    const VectorXd& weight = block.soft_weight;
    if (weight.size() != 0 && weight.size() != block.F.rows()) {
      fail(fmt::format("{}: soft_weight has {} numbers, must have {} or none", name, weight.size(),
                       block.F.rows()));
    }
    for (Index i = 0; i < weight.size(); ++i) {
      if (weight[i] > 0.0) continue;
      fail(fmt::format("{}: soft_weight {} = {:g}, must be > 0", name, i, weight[i]));
    }
  }

  [[noreturn]] void fail(const std::string& what) const { throw ConfigError(who_ + ": " + what); }

 private:
  const std::string& who_;
};

/// x_k = ... + Gamma_k u with k = 1..N, one under the other.
MatrixXd effect_of_inputs(const LinearMpcProblem& problem) {
  const Index n = problem.A.rows(), m = problem.B.cols(), N = problem.horizon;
  MatrixXd Gamma = MatrixXd::Zero(N * n, N * m);
  for (Index k = 0; k < N; ++k) {
    Gamma.block(k * n, k * m, n, m) = problem.B;
    if (k == 0) continue;
    Gamma.block(k * n, 0, n, k * m) = problem.A * Gamma.block((k - 1) * n, 0, n, k * m);
  }
  return Gamma;
}

MatrixXd hessian(const LinearMpcProblem& problem, const MatrixXd& Gamma) {
  const Index n = problem.A.rows(), m = problem.B.cols(), N = problem.horizon;
  MatrixXd H = MatrixXd::Zero(N * m, N * m);
  for (Index k = 0; k < N; ++k) {
    const Index reach = (k + 1) * m;
    const auto Gamma_k = Gamma.block(k * n, 0, n, reach);
    const MatrixXd& weight = k == N - 1 ? problem.P : problem.Q;
    H.topLeftCorner(reach, reach) += 2.0 * Gamma_k.transpose() * weight * Gamma_k;
    H.block(k * m, k * m, m, m) += 2.0 * problem.R;
  }
  return 0.5 * (H + H.transpose());
}

class RowBuilder {
 public:
  RowBuilder(const LinearMpcProblem& problem, const MatrixXd& Gamma, Condensed& out)
      : problem_(problem), Gamma_(Gamma), out_(out) {
    Index max_rows = problem.horizon * problem.B.cols();
    for (const MpcStateRows& block : problem.state_rows)
      max_rows += problem.horizon * block.F.rows();
    for (const MpcStateRows& block : problem.terminal_rows) max_rows += block.F.rows();
    out_.rows.setZero(max_rows, Gamma.cols());
    out_.F.resize(0, problem.A.cols());
    out_.F_relative.resize(0, problem.A.cols());
  }

  /// @returns the index of the block's first row in F or F_relative
  int add_matrix(const MpcStateRows& block) {
    MatrixXd& F = block.relative ? out_.F_relative : out_.F;
    const Index first = F.rows();
    if (block.F.rows() == 0) return static_cast<int>(first);
    F.conservativeResize(first + block.F.rows(), Eigen::NoChange);
    F.bottomRows(block.F.rows()) = block.F;
    return static_cast<int>(first);
  }

  void add_states(const MpcStateRows& block, int step, int first_F_row) {
    const Index n = problem_.A.rows(), reach = step * problem_.B.cols();
    const auto Gamma_k = Gamma_.block((step - 1) * n, 0, n, reach);
    const double size = Gamma_k.norm();
    for (Index i = 0; i < block.F.rows(); ++i) {
      if (std::isinf(block.lower[i]) && std::isinf(block.upper[i])) continue;
      StateLimit limit;
      limit.step = step;
      limit.F_row = first_F_row + static_cast<int>(i);
      limit.relative = block.relative;
      limit.lower = block.lower[i];
      limit.upper = block.upper[i];
      limit.weight = block.soft_weight.size() != 0 ? block.soft_weight[i] : kInfinity;
      const Eigen::RowVectorXd row = block.F.row(i) * Gamma_k;
      if (row.norm() <= kRoundingRow * block.F.row(i).norm() * size) {
        out_.unreached.push_back(limit);
      } else {
        out_.rows.row(count()).head(reach) = row;
        out_.limits.push_back(limit);
      }
    }
  }

  /// Limits of u_step - u_{step-1}.
  void add_rates(int step) {
    const Index m = problem_.B.cols();
    for (Index i = 0; i < problem_.rate_lower.size(); ++i) {
      StateLimit limit;
      limit.lower = problem_.rate_lower[i];
      limit.upper = problem_.rate_upper[i];
      limit.weight = kInfinity;
      if (std::isinf(limit.lower) && std::isinf(limit.upper)) continue;
      out_.rows(count(), step * m + i) = 1.0;
      out_.rows(count(), (step - 1) * m + i) = -1.0;
      out_.limits.push_back(limit);
    }
  }

  void finish() { out_.rows.conservativeResize(count(), Eigen::NoChange); }

 private:
  Index count() const { return static_cast<Index>(out_.limits.size()); }

  const LinearMpcProblem& problem_;
  const MatrixXd& Gamma_;
  Condensed& out_;
};

}  // namespace

void check(const LinearMpcProblem& problem, const std::string& who) {
  const Checker checker(who);
  const Index n = problem.A.rows(), m = problem.B.cols();
  if (n == 0) checker.fail("A has no rows");
  if (m == 0) checker.fail("B has no columns");
  checker.matrix("A", problem.A, n, n);
  checker.matrix("B", problem.B, n, m);
  checker.weight("Q", problem.Q, n);
  checker.weight("R", problem.R, m);
  checker.weight("P", problem.P, n);
  if (problem.horizon < 1) {
    checker.fail(fmt::format("horizon = {}, must be >= 1", problem.horizon));
  }
  checker.limits("input", problem.input_lower, problem.input_upper, m, true);
  checker.limits("rate", problem.rate_lower, problem.rate_upper, m, true);
  for (std::size_t i = 0; i < problem.state_rows.size(); ++i) {
    checker.rows(fmt::format("state_rows {}", i), problem.state_rows[i], n);
  }
  for (std::size_t i = 0; i < problem.terminal_rows.size(); ++i) {
    checker.rows(fmt::format("terminal_rows {}", i), problem.terminal_rows[i], n);
  }
}

Condensed condense(const LinearMpcProblem& problem) {
  const MatrixXd Gamma = effect_of_inputs(problem);
  Condensed result;
  result.H = hessian(problem, Gamma);
  RowBuilder builder(problem, Gamma, result);
  std::vector<int> first_row;
  for (const MpcStateRows& block : problem.state_rows) {
    first_row.push_back(builder.add_matrix(block));
  }
  for (int step = 1; step <= problem.horizon; ++step) {
    if (step >= 2) builder.add_rates(step - 1);
    for (std::size_t i = 0; i < problem.state_rows.size(); ++i) {
      builder.add_states(problem.state_rows[i], step, first_row[i]);
    }
  }
  for (const MpcStateRows& block : problem.terminal_rows) {
    builder.add_states(block, problem.horizon, builder.add_matrix(block));
  }
  builder.finish();
  return result;
}

}  // namespace vinerow::controllers::mpc
