#pragma once
/// Prediction of a linear model over the horizon, and its adjoint: the part of a condensed MPC that
/// depends on state, reference and disturbance. No heap after construction.

#include <Eigen/Core>

#include "controllers/parts/solvers/mpc_form.h"
#include "controllers/parts/solvers/sparse_rows.h"

namespace vinerow::controllers::mpc {

class Prediction {
 public:
  using Vector = Eigen::Ref<const Eigen::VectorXd>;
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

  Prediction(const LinearMpcProblem& problem, const Condensed& form);

  /// The states for zero inputs, and their deviation from the reference.
  void predict_without_inputs(const Vector& x, const Vector& disturbance, const Matrix& reference);
  /// f, m x N: gradient of the cost with respect to the inputs, at zero inputs.
  /// @pre predict_without_inputs()
  void find_gradient(const Matrix& input_reference, Eigen::MatrixXd& f);
  /// states: n x (N + 1)
  void predict(const Vector& x, const Vector& disturbance, const Eigen::MatrixXd& inputs,
               Eigen::MatrixXd& states) const;

  /// F x_k (- F r_k) of all limits: at zero inputs, or for given states.
  void evaluate_limits() { evaluate_limits(free_); }
  void evaluate_limits(const Eigen::MatrixXd& states, const Matrix& reference);
  /// Index of a limit's value in values(); the value of a rate is zero.
  int index_of(const StateLimit& limit) const;
  const double* values() const { return values_.data(); }

 private:
  void evaluate_limits(const Eigen::MatrixXd& states);

  Eigen::Index n_, N_;
  // The cost's derivatives carry the factor 2 of x'Qx.
  SparseRows A_, A_transposed_, B_, B_transposed_, two_Q_, two_P_, minus_two_R_;
  SparseRows F_, F_relative_;
  Eigen::MatrixXd free_, error_;  // n x (N + 1)
  Eigen::VectorXd costate_, costate_before_;
  Eigen::VectorXd values_;  // zero; then for each step those of F and of F_relative
};

}  // namespace vinerow::controllers::mpc
