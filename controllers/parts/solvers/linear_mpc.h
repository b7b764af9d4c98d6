#pragma once
/// Condensed linear model predictive control over QpSolver:
///
///   minimise   sum_{k=0}^{N-1} |x_k - r_k|_Q^2 + |u_k - v_k|_R^2 + |x_N - r_N|_P^2
///   subject to x_{k+1} = A x_k + B u_k + d_k,  x_0 given
///              input_lower <= u_k <= input_upper
///              rate_lower <= u_k - u_{k-1} <= rate_upper              (u_{-1} given)
///              lower <= F x_k (- F r_k if relative) <= upper          k = 1..N
///              lower <= F_N x_N (- F_N r_N if relative) <= upper      (terminal)
///
/// where |x|_Q^2 = x'Qx. Rows of states can be soft with a quadratic cost. The constructor
/// eliminates the states once; a solve() then costs a prediction without inputs, its adjoint for
/// the gradient, and the QP. No heap after construction. The same sequence of calls gives the same
/// bits. The rate limits of u_0 are merged into its bounds. So an input_before from which no rate
/// leads into the bounds makes the problem infeasible, as does a hard row that x_0 violates
/// irrecoverably. Source: Borrelli, Bemporad, Morari, "Predictive Control for Linear and Hybrid
/// Systems", 2017, section 8.2 (batch approach).

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "controllers/parts/solvers/qp.h"

namespace vinerow::controllers {

/// Rows lower <= F x <= upper on every predicted state, or on the last one.
struct MpcStateRows {
  Eigen::MatrixXd F;      ///< rows x n; zero rows: none
  Eigen::VectorXd lower;  ///< may be infinite, as upper
  Eigen::VectorXd upper;
  /// 1/2 weight s^2 for a violation s; infinity: hard. One per row, or empty: all hard.
  Eigen::VectorXd soft_weight;
  bool relative = false;  ///< limits apply to F (x - reference)
};

struct LinearMpcProblem {
  Eigen::MatrixXd A;                         ///< n x n
  Eigen::MatrixXd B;                         ///< n x m
  Eigen::MatrixXd Q;                         ///< n x n, >= 0
  Eigen::MatrixXd R;                         ///< m x m, > 0
  Eigen::MatrixXd P;                         ///< n x n, >= 0, weight of the last state
  int horizon = 20;                          ///< N >= 1
  Eigen::VectorXd input_lower, input_upper;  ///< m, or empty: no bounds
  Eigen::VectorXd rate_lower, rate_upper;    ///< m, per step, or empty: no limits
  std::vector<MpcStateRows> state_rows;      ///< several blocks, e.g. absolute and relative
  std::vector<MpcStateRows> terminal_rows;
};

class LinearMpc {
 public:
  /// @throws ConfigError with the matrix and its shape, if sizes do not fit or the condensed
  /// Hessian is not positive definite
  /// @param who  for errors, "drone.controller"
  LinearMpc(const LinearMpcProblem& problem, const std::string& who,
            const QpSettings& settings = {});
  ~LinearMpc();
  LinearMpc(LinearMpc&&) noexcept;
  LinearMpc& operator=(LinearMpc&&) noexcept;

  int states() const;
  int inputs() const;
  int horizon() const;

  /// @param x  n, the current state  @param reference  n x (N + 1), r_0 is not used but must be
  /// finite
  /// @param input_reference  m x N  @param disturbance  n, d_k for all k
  /// @param input_before  m, used if there are rate limits
  /// @returns kInvalidInput if any of these contains a number that is not finite.
  /// After any status but kSolved the inputs are those of the call before, shifted by one step and
  /// clamped to the input bounds, never NaN; before the first kSolved they are zero, clamped. The
  /// next solve() then starts cold.
  QpStatus solve(const Eigen::Ref<const Eigen::VectorXd>& x,
                 const Eigen::Ref<const Eigen::MatrixXd>& reference,
                 const Eigen::Ref<const Eigen::MatrixXd>& input_reference,
                 const Eigen::Ref<const Eigen::VectorXd>& disturbance,
                 const Eigen::Ref<const Eigen::VectorXd>& input_before);
  /// Forgets all earlier calls: the active set and the inputs.
  void cold_start();

  Eigen::Ref<const Eigen::VectorXd> u() const;  ///< the first input, m
  const Eigen::MatrixXd& inputs_ahead() const;  ///< m x N
  /// n x (N + 1), x_0 first: the states under inputs_ahead(), computed on the first call.
  /// If x or the disturbance is not finite, these are the states of the call before, shifted.
  const Eigen::MatrixXd& states_ahead() const;
  /// Largest violation of a soft row in the prediction, in the row's unit; 0 if all are satisfied
  /// or the input is invalid.
  double soft_violation() const;
  int iterations() const;  ///< of the QP
  double cost() const;     ///< of the QP, without constants

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::controllers
