#include "controllers/parts/solvers/mpc_prediction.h"

#include <utility>

namespace vinerow::controllers::mpc {

using Eigen::Index;
using Eigen::MatrixXd;

Prediction::Prediction(const LinearMpcProblem& problem, const Condensed& form)
    : n_(problem.A.rows()),
      N_(problem.horizon),
      A_(problem.A),
      A_transposed_(problem.A.transpose()),
      B_(problem.B),
      B_transposed_(problem.B.transpose()),
      two_Q_(2.0 * problem.Q),
      two_P_(2.0 * problem.P),
      minus_two_R_(-2.0 * problem.R),
      F_(form.F),
      F_relative_(form.F_relative) {
  free_.setZero(n_, N_ + 1);
  error_.setZero(n_, N_ + 1);
  costate_.setZero(n_);
  costate_before_.setZero(n_);
  values_.setZero(1 + N_ * (F_.rows() + F_relative_.rows()));
}

void Prediction::predict_without_inputs(const Vector& x, const Vector& disturbance,
                                        const Matrix& reference) {
  double* now = free_.data();
  for (Index i = 0; i < n_; ++i) now[i] = x[i];
  for (Index k = 1; k <= N_; ++k, now += n_) {
    double* next = now + n_;
    A_.product(now, next);
    for (Index i = 0; i < n_; ++i) next[i] += disturbance[i];
    const double* wanted = reference.col(k).data();
    double* error = error_.col(k).data();
    for (Index i = 0; i < n_; ++i) error[i] = next[i] - wanted[i];
  }
}

/// Adjoint of the prediction: costate_k = 2 Q (x_k - r_k) + A' costate_{k+1}. The gradient with
/// respect to u_k is B' costate_{k+1} - 2 R v_k.
void Prediction::find_gradient(const Matrix& input_reference, MatrixXd& f) {
  double *costate = costate_.data(), *before = costate_before_.data();
  two_P_.product(error_.col(N_).data(), costate);
  for (Index k = N_ - 1; k >= 0; --k) {
    B_transposed_.product(costate, f.col(k).data());
    minus_two_R_.add_product(input_reference.col(k).data(), f.col(k).data());
    if (k == 0) break;
    two_Q_.product(error_.col(k).data(), before);
    A_transposed_.add_product(costate, before);
    std::swap(costate, before);
  }
}

void Prediction::predict(const Vector& x, const Vector& disturbance, const MatrixXd& inputs,
                         MatrixXd& states) const {
  states.col(0) = x;
  for (Index k = 0; k < N_; ++k) {
    double* next = states.col(k + 1).data();
    A_.product(states.col(k).data(), next);
    B_.add_product(inputs.col(k).data(), next);
    for (Index i = 0; i < n_; ++i) next[i] += disturbance[i];
  }
}

void Prediction::evaluate_limits(const MatrixXd& states, const Matrix& reference) {
  error_ = states - reference;
  evaluate_limits(states);
}

void Prediction::evaluate_limits(const MatrixXd& states) {
  double* value = values_.data() + 1;
  for (Index k = 1; k <= N_; ++k) {
    F_.product(states.col(k).data(), value);
    F_relative_.product(error_.col(k).data(), value + F_.rows());
    value += F_.rows() + F_relative_.rows();
  }
}

int Prediction::index_of(const StateLimit& limit) const {
  if (limit.step == 0) return 0;
  const int row = limit.relative ? F_.rows() + limit.F_row : limit.F_row;
  return 1 + (limit.step - 1) * (F_.rows() + F_relative_.rows()) + row;
}

}  // namespace vinerow::controllers::mpc
