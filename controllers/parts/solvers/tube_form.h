#pragma once
/// Online problem of tube MPC as a dense QP. Variables y are the nominal state z_0 and, after it,
/// c_0 .. c_{N-1} of v_i = K z_i + c_i, so that z_{i+1} = A_K z_i + B c_i: predictions do not
/// grow along the horizon, and with the P of make_tube_weight() the cost is
///   sum |z_i|_Q^2 + |v_i|_R^2 + |z_N|_P^2
///     = |z_0|_P^2 + sum |c_i|_(R + B'PB)^2 + 2 c_i' (R K + B'P A_K) z_i,
/// where the last term is zero if K is the gain of the LQR. Source: Rossiter, Kouvaritakis, Rice,
/// "A numerically robust state-space approach to stable-predictive control strategies", Automatica
/// 34(1), 1998.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/solvers/tube_sets.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

struct TubeCost {
  Eigen::MatrixXd Q;  ///< n x n, >= 0
  Eigen::MatrixXd R;  ///< m x m, > 0
  int horizon = 20;   ///< N >= 1
};

/// P of the cost to go under v = K z: P = A_K' P A_K + Q + K' R K. With the LQR's K it is the
/// solution of the Riccati equation. @returns a failure if A_K is not Schur stable
Result<Eigen::MatrixXd> make_tube_weight(const TubeModel& model, const TubeCost& cost);

/// Meaning of a row of the QP.
struct TubeRow {
  enum class Kind {
    kTube,      ///< F (x - z_0), hard
    kState,     ///< limit of z_i, soft
    kInput,     ///< limit of v_i, hard
    kTerminal,  ///< terminal set of z_N, soft
  };
  Kind kind = Kind::kState;
  int step = 0;
  int index = 0;  ///< of the state, the input, or the row of its set
};

struct TubeForm {
  Eigen::MatrixXd H;  ///< for 1/2 y'Hy
  /// Divided by their limits: |row y| <= 1. Rows of the tube, |row y - F x| <= 1, come first.
  /// Sorted by steps, so that rows of early steps end in zeros.
  Eigen::MatrixXd rows;
  std::vector<TubeRow> about;  ///< one for each row
  /// The cost does not couple c with z (to 1e-9), because K is the LQR's: c = 0 is the optimum if
  /// no limit is active.
  bool is_decoupled = false;
};

/// @param with_tube  false: z_0 is given, F is left out
TubeForm make_tube_form(const TubeModel& model, const TubeSets& sets, const TubeCost& cost,
                        const Eigen::MatrixXd& P, bool with_tube);

}  // namespace vinerow::controllers
