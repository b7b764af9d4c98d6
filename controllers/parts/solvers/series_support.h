#pragma once
/// Support of S = W + A W + A^2 W + ..., the smallest set that a disturbance w in W cannot push the
/// state of x+ = A x + w out of (minimal robust invariant set): the sum of h_W(A'^j c) plus a bound
/// of the remainder. W may have an empty interior.
///
/// Bound: q(c) = sum |c_j| r_j with r_j at least the reach of W along axis j has h_W <= q. For some
/// m, q(A'^m c) <= beta q(c), beta <= 1/2, for every c; so after a block of m terms with sum B of q
/// the remainder is at most B beta / (1 - beta). Source: Kolmanovsky, Gilbert, "Theory and
/// computation of disturbance invariant sets for discrete-time linear systems", Math. Probl. Eng.
/// 4, 1998, section 4.

#include <Eigen/Core>

#include "controllers/parts/solvers/support.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

class SeriesSupport {
 public:
  /// @param A  n x n @param W  support of the disturbance in n dimensions, bounded
  /// @returns a failure if A is not Schur stable, or W is empty or unbounded
  /// @throws ConfigError if sizes do not fit
  static Result<SeriesSupport> make(const Eigen::MatrixXd& A, const Support& W);

  struct Bound {
    double value = 0.0;   ///< not below h_S(c), except for rounding
    double excess = 0.0;  ///< largest excess over h_S(c): 1e-12 of its size
    int terms = 0;
  };
  Bound bound(const Eigen::VectorXd& c) const;
  double operator()(const Eigen::VectorXd& c) const { return bound(c).value; }

  /// m, see above.
  int block() const { return block_; }

 private:
  SeriesSupport() = default;

  Eigen::MatrixXd A_;
  Support W_;
  Eigen::VectorXd reach_;  // r
  int block_ = 1;
  double contraction_ = 0.0;
};

}  // namespace vinerow::controllers
