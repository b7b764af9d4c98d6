#pragma once
/// Sets that x+ = A x + w, w in W, does not leave.
///
/// Here the maximal one: all states whose whole future keeps the constraints, for MPC's last state.
/// The minimal one, what the disturbance alone can do, is in series_support.h (its support). For
/// setting up controllers, not for their steps. ConfigError where sizes do not fit.

#include <Eigen/Core>

#include "controllers/parts/solvers/polytope.h"
#include "controllers/parts/solvers/support.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

struct InvariantSettings {
  int max_steps = 500;
  /// Of a row's size: a cut that takes away less is none, so the set is invariant to within this.
  double tolerance = 1e-9;
};

struct InvariantSet {
  Polytope set;   ///< without redundant rows
  int steps = 0;  ///< t*: constraints at steps 0..t* imply those at all later ones
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
/// @returns further a failure if the disturbance alone leads out of X: the set is empty
Result<InvariantSet> maximal_robust_invariant_set(const Eigen::MatrixXd& A, const Polytope& X,
                                                  const Support& W,
                                                  const InvariantSettings& settings = {});

}  // namespace vinerow::controllers
