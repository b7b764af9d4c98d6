#include "tests/controllers/parts/solvers/qp_support.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::test {
namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

int uniform_int(RandomStream& random, int low, int high) {
  return low + static_cast<int>(random.uniform() * (high - low + 1));
}
}  // namespace

QpProblem::QpProblem(int n, int m)
    : H(Eigen::MatrixXd::Identity(n, n)),
      A(Eigen::MatrixXd::Zero(m, n)),
      f(Eigen::VectorXd::Zero(n)),
      lower(Eigen::VectorXd::Constant(n, -kInfinity)),
      upper(Eigen::VectorXd::Constant(n, kInfinity)),
      row_lower(Eigen::VectorXd::Constant(m, -kInfinity)),
      row_upper(Eigen::VectorXd::Constant(m, kInfinity)),
      weight(Eigen::VectorXd::Constant(m, kInfinity)) {}

bool QpProblem::prepare(controllers::QpSolver& solver) const {
  solver.set_rows(A);
  for (int r = 0; r < m(); ++r) solver.soften_row(r, weight[r]);
  return solver.set_hessian(H);
}

controllers::QpStatus QpProblem::solve(controllers::QpSolver& solver) const {
  return solver.solve(f, lower, upper, row_lower, row_upper);
}

double QpResiduals::largest() const {
  return std::max(std::max(stationarity, primal), std::max(dual_sign, complementarity));
}

QpResiduals qp_residuals(const QpProblem& problem, const controllers::QpSolver& solver) {
  const int n = problem.n(), m = problem.m();
  const Eigen::VectorXd& x = solver.x();
  const Eigen::VectorXd& lambda = solver.multipliers();
  QpResiduals result;
  // Relative to the terms that cancel: x itself is known to its last bit only, and a Hessian of
  // condition 1e8 makes much of that.
  const Eigen::VectorXd residual =
      problem.H * x + problem.f + lambda.head(n) + problem.A.transpose() * lambda.tail(m);
  const Eigen::VectorXd size = problem.H.cwiseAbs() * x.cwiseAbs() + lambda.head(n).cwiseAbs() +
                               problem.A.cwiseAbs().transpose() * lambda.tail(m).cwiseAbs();
  result.stationarity = residual.cwiseAbs().maxCoeff() / (1.0 + size.maxCoeff());
  for (int i = 0; i < n + m; ++i) {
    const int r = i - n;
    const double value = i < n ? x[i] : problem.A.row(r).dot(x);
    const double slack = i < n ? 0.0 : lambda[i] / problem.weight[r];
    double length = i < n ? 1.0 : problem.A.row(r).norm();
    if (length == 0.0) length = 1.0;
    const double low = i < n ? problem.lower[i] : problem.row_lower[r];
    const double up = i < n ? problem.upper[i] : problem.row_upper[r];
    const double over = value - slack - up, under = low - (value - slack);
    result.primal = std::max({result.primal, over / length, under / length});
    if (lambda[i] == 0.0 || low == up) continue;
    const double gap = lambda[i] > 0.0 ? -over : -under;  // to the limit that the sign names
    if (!std::isfinite(gap)) result.dual_sign = kInfinity;
    result.complementarity = std::max(
        result.complementarity, std::min(std::abs(gap) / length, std::abs(lambda[i] * length)));
  }
  return result;
}

Eigen::MatrixXd random_matrix(RandomStream& random, int rows, int columns) {
  Eigen::MatrixXd result(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) result(i, j) = random.normal();
  }
  return result;
}

Eigen::MatrixXd random_hessian(RandomStream& random, int n, double log10_condition) {
  const Eigen::MatrixXd Q = random_matrix(random, n, n).householderQr().householderQ();
  Eigen::VectorXd eigenvalues(n);
  for (int i = 0; i < n; ++i) eigenvalues[i] = std::pow(10.0, random.uniform(0, log10_condition));
  eigenvalues[0] = 1.0;
  eigenvalues[n - 1] = std::pow(10.0, log10_condition);
  const Eigen::MatrixXd H = Q * eigenvalues.asDiagonal() * Q.transpose();
  return 0.5 * (H + H.transpose());
}

QpProblem random_feasible_qp(RandomStream& random, const QpRandomKind& kind) {
  const int n = uniform_int(random, 2, kind.max_variables);
  const int m = uniform_int(random, 0, kind.max_rows);
  QpProblem problem(n, m);
  problem.H = random_hessian(random, n, kind.log10_condition);
  const double pull = std::pow(10.0, random.uniform(0.0, 2.0));
  problem.f = pull * random_matrix(random, n, 1);
  problem.A = random_matrix(random, m, n);
  const Eigen::VectorXd point = random_matrix(random, n, 1);
  for (int r = 0; r < m; ++r) {
    const double choice = kind.degenerate ? random.uniform() : 1.0;
    if (choice < 0.1 && r > 0) {
      problem.A.row(r) = problem.A.row(uniform_int(random, 0, r - 1));
    } else if (choice < 0.2 && r > 1) {
      problem.A.row(r) = random.normal() * problem.A.row(uniform_int(random, 0, r - 1)) +
                         random.normal() * problem.A.row(uniform_int(random, 0, r - 1));
    } else if (choice < 0.25) {
      problem.A.row(r).setZero();
      problem.A(r, uniform_int(random, 0, n - 1)) = 1.0;
    }
  }
  // Lengths come last, so that a dependent row is not a long row's with a trace of a short one.
  for (int r = 0; r < m; ++r) {
    problem.A.row(r) *= std::pow(10.0, random.uniform(-kind.log10_length, kind.log10_length));
  }
  const Eigen::VectorXd values = problem.A * point;
  int equalities = 0;
  for (int i = 0; i < n + m; ++i) {
    const bool bound = i < n;
    const double value = bound ? point[i] : values[i - n];
    const double length = bound ? 1.0 : problem.A.row(i - n).norm();
    double& low = bound ? problem.lower[i] : problem.row_lower[i - n];
    double& up = bound ? problem.upper[i] : problem.row_upper[i - n];
    // A degenerate limit passes through the point itself.
    const bool touches = kind.degenerate && random.uniform() < 0.3;
    const double below = touches ? 0.0 : length * random.uniform(0.0, 1.0);
    const double above = length * random.uniform(0.0, 1.0);
    const double choice = random.uniform();
    if (choice < 0.1 && kind.equalities && !bound && equalities < n - 1) {
      low = up = value;
      ++equalities;
    } else if (choice < 0.4) {
      low = value - below;
    } else if (choice < 0.7) {
      up = value + (touches ? 0.0 : above);
    } else if (choice < 0.95) {
      low = value - below;
      up = value + above;
    }
  }
  return problem;
}

}  // namespace vinerow::test
