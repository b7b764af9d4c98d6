#pragma once
/// Maximal sets that x+ = A x + w, w in W, does not leave.
///
/// The maximal set holds all states whose whole future satisfies the constraints, for MPC's
/// terminal state. The minimal set, which the disturbance alone can reach, is in series_support.h
/// (its support). For the set-up of controllers, not for their steps. ConfigError if sizes do not
/// fit.

#include <Eigen/Core>

#include "controllers/parts/solvers/polytope.h"
#include "controllers/parts/solvers/support.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

struct InvariantSettings {
  int max_steps = 500;
  /// Relative to a row's size: a cut that removes less is ignored, so the set is invariant to
  /// within this.
  double tolerance = 1e-9;
};

struct InvariantSet {
  Polytope set;   ///< without redundant rows
  int steps = 0;  ///< t*: constraints at steps 0..t* imply those at all later steps
};

/// All x with A^k x in X for every k >= 0 (maximal positively invariant subset of X, also "maximal
/// output admissible set"). With a feedback u = K x and limits on u: X = states.intersection(
/// inputs.linear_preimage(K)), A = A + B K.
/// Source: Gilbert, Tan, "Linear systems with state and control constraints: the theory and
/// application of maximal output admissible sets", IEEE TAC 36(9), 1991, algorithm 3.2.
/// @param A  n x n, Schur stable @param X  with the origin inside; need not be bounded
/// @returns a failure if A is not Schur stable, the origin is not inside X, or the steps do not
/// suffice
Result<InvariantSet> maximal_invariant_set(const Eigen::MatrixXd& A, const Polytope& X,
                                           const InvariantSettings& settings = {});

/// All x from which no sequence of disturbances leads out of X.
/// Source: Kolmanovsky, Gilbert, "Theory and computation of disturbance invariant sets for
/// discrete-time linear systems", Math. Probl. Eng. 4, 1998, section 6.
/// @param W  support of the disturbance, bounded
/// @returns also a failure if the disturbance alone leads out of X: the set is empty
Result<InvariantSet> maximal_robust_invariant_set(const Eigen::MatrixXd& A, const Polytope& X,
                                                  const Support& W,
                                                  const InvariantSettings& settings = {});

}  // namespace vinerow::controllers
