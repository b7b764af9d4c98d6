#pragma once
/// A linear MPC problem checked, and its states eliminated:
///   x_k = A^k x_0 + sum_{j<k} A^(k-1-j) (B u_j + d),
/// so that the inputs of the horizon, one after the other, are the variables of the QP.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "controllers/parts/linear_mpc.h"
#include "controllers/parts/sparse_rows.h"

namespace vinerow::mpc {

/// A limit on a predicted state: lower <= F x_step (- F r_step) <= upper.
struct StateLimit {
  int step = 0;  ///< 1..N
  int F_row = 0;
  double lower = 0.0, upper = 0.0;
  double weight = 0.0;  ///< infinite: hard
  bool relative = false;
  int qp_row = -1;  ///< -1: no input of the horizon reaches it
};

/// A limit on u_step - u_{step-1}.
struct RateLimit {
  int qp_row = 0;
  double lower = 0.0, upper = 0.0;
};

struct Condensed {
  Eigen::MatrixXd H;     ///< Nm x Nm, for the cost 1/2 u'Hu: twice the sum of weights
  Eigen::MatrixXd rows;  ///< in the order of steps, so that rows of early steps end in zeros
  SparseRows F;          ///< rows of all blocks of state and terminal limits
  std::vector<StateLimit> reached;    ///< those with a row of the QP
  std::vector<StateLimit> unreached;  ///< those without: the state now and d decide on them
  std::vector<RateLimit> rates;       ///< of steps 1..N-1; the one of step 0 is a bound
};

/// @throws ConfigError "<who>: Q is 11 x 12, must be 12 x 12"
void check(const LinearMpcProblem& problem, const std::string& who);

/// @pre checked
Condensed condense(const LinearMpcProblem& problem);

}  // namespace vinerow::mpc
