#pragma once
/// What the tests of the QP solver share: problems as data, random ones, and the judge.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/solvers/qp.h"
#include "engine/core/random.h"

namespace vinerow::test {

struct QpProblem {
  Eigen::MatrixXd H, A;                                   ///< n x n, m x n
  Eigen::VectorXd f, lower, upper, row_lower, row_upper;  ///< n, n, n, m, m
  Eigen::VectorXd weight;                                 ///< m, infinite where a row is hard

  /// No bounds and no rows but zero ones, all limits infinite.
  QpProblem(int n, int m);
  int n() const { return static_cast<int>(f.size()); }
  int m() const { return static_cast<int>(row_lower.size()); }
  bool prepare(controllers::QpSolver& solver) const;
  controllers::QpStatus solve(controllers::QpSolver& solver) const;
};

/// Largest residuals of the optimality conditions, which for a strictly convex programme prove the
/// optimum. Violations are per length of the row.
struct QpResiduals {
  double stationarity = 0.0, primal = 0.0, dual_sign = 0.0, complementarity = 0.0;
  double largest() const;
};
QpResiduals qp_residuals(const QpProblem& problem, const controllers::QpSolver& solver);

struct QpRandomKind {
  int max_variables = 30, max_rows = 60;
  double log10_condition = 2.0;  ///< of H
  double log10_length = 0.0;     ///< rows of length 10^-this .. 10^this
  bool degenerate = true;        ///< duplicated and dependent rows, several limits met in one point
  bool equalities = true;
};
/// A problem that the point it is built around satisfies.
QpProblem random_feasible_qp(RandomStream& random, const QpRandomKind& kind);

Eigen::MatrixXd random_matrix(RandomStream& random, int rows, int columns);
/// Q diag Q' with eigenvalues from 1 to 10^log10_condition
Eigen::MatrixXd random_hessian(RandomStream& random, int n, double log10_condition);

}  // namespace vinerow::test
