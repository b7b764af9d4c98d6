#pragma once
/// Check of a linear MPC problem and elimination of its states:
///   x_k = A^k x_0 + sum_{j<k} A^(k-1-j) (B u_j + d),
/// so that the inputs of the horizon, one after the other, are the variables of the QP.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "controllers/parts/solvers/linear_mpc.h"

namespace vinerow::controllers::mpc {

/// A limit on a predicted state: lower <= F x_step (- F r_step) <= upper.
struct StateLimit {
  int step = 0;   ///< 1..N
  int F_row = 0;  ///< of Condensed::F, or of F_relative if the reference is subtracted
  bool relative = false;
  double lower = 0.0, upper = 0.0;
  double weight = 0.0;  ///< infinite: hard
};

struct Condensed {
  Eigen::MatrixXd H;  ///< Nm x Nm, for the cost 1/2 u'Hu: twice the sum of weights
  /// Sorted by steps, so that rows of early steps end in zeros.
  Eigen::MatrixXd rows;
  /// One per row; those of input rates, at step 0, have a limit only.
  std::vector<StateLimit> limits;
  /// Limits that no input of the horizon affects: they depend on the current state and d only.
  std::vector<StateLimit> unreached;
  Eigen::MatrixXd F, F_relative;  ///< rows of all blocks
};

/// @throws ConfigError "<who>: Q is 11 x 12, must be 12 x 12"
void check(const LinearMpcProblem& problem, const std::string& who);

/// @pre check() has passed
Condensed condense(const LinearMpcProblem& problem);

}  // namespace vinerow::controllers::mpc
