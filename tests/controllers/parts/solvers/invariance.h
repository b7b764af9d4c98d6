#pragma once
/// Judges whether sets are invariant, by the definition.

#include <algorithm>
#include <limits>

#include "controllers/parts/solvers/polytope.h"

namespace vinerow::test {

/// How far x+ = A x + w leads out of P from its worst point, over rows of length one; <= 0 where P
/// is invariant. -infinity if P is empty. @param W  support of the disturbance
inline double invariance_excess(const Eigen::MatrixXd& A, const controllers::Polytope& P,
                                const controllers::Support& W) {
  double worst = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < P.rows(); ++i) {
    const Eigen::VectorXd row = P.F().row(i);
    const double length = row.norm();
    if (length == 0.0) continue;
    const double reached = P.support(A.transpose() * row) + W(row);
    worst = std::max(worst, (reached - P.g()[i]) / length);
  }
  return worst;
}

}  // namespace vinerow::test
