#include "controllers/parts/solvers/lp_basis.h"

#include <cmath>
#include <utility>

namespace vinerow::controllers::lp {

Basis::Basis(int n)
    : n_(n),
      columns_(Eigen::MatrixXd::Identity(n, n)),
      factors_(Eigen::MatrixXd::Identity(n, n)),
      order_(static_cast<std::size_t>(n)),
      residual_(Eigen::VectorXd::Zero(n)),
      moved_(Eigen::VectorXd::Zero(n)) {}

bool Basis::factor() {
  factors_ = columns_;
  for (int i = 0; i < n_; ++i) order_[static_cast<std::size_t>(i)] = i;
  for (int k = 0; k < n_; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n_; ++i) {
      if (std::abs(factors_(i, k)) > std::abs(factors_(pivot, k))) pivot = i;
    }
    if (!(std::abs(factors_(pivot, k)) > 0.0) || !std::isfinite(factors_(pivot, k))) return false;
    if (pivot != k) {
      for (int j = 0; j < n_; ++j) std::swap(factors_(pivot, j), factors_(k, j));
      std::swap(order_[static_cast<std::size_t>(pivot)], order_[static_cast<std::size_t>(k)]);
    }
    for (int i = k + 1; i < n_; ++i) factors_(i, k) /= factors_(k, k);
    for (int j = k + 1; j < n_; ++j) {
      const double upper = factors_(k, j);
      for (int i = k + 1; i < n_; ++i) factors_(i, j) -= factors_(i, k) * upper;
    }
  }
  return true;
}

void Basis::apply_inverse(Eigen::VectorXd& v) {
  for (int i = 0; i < n_; ++i) moved_[i] = v[order_[static_cast<std::size_t>(i)]];
  for (int j = 0; j < n_; ++j) {
    for (int i = j + 1; i < n_; ++i) moved_[i] -= factors_(i, j) * moved_[j];
  }
  for (int j = n_ - 1; j >= 0; --j) {
    moved_[j] /= factors_(j, j);
    for (int i = 0; i < j; ++i) moved_[i] -= factors_(i, j) * moved_[j];
  }
  v = moved_;
}

void Basis::apply_inverse_transposed(Eigen::VectorXd& v) {
  moved_ = v;
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j < i; ++j) moved_[i] -= factors_(j, i) * moved_[j];
    moved_[i] /= factors_(i, i);
  }
  for (int i = n_ - 1; i >= 0; --i) {
    for (int j = i + 1; j < n_; ++j) moved_[i] -= factors_(j, i) * moved_[j];
  }
  for (int i = 0; i < n_; ++i) v[order_[static_cast<std::size_t>(i)]] = moved_[i];
}

void Basis::solve(const Eigen::VectorXd& c, Eigen::VectorXd& y) {
  y = c;
  apply_inverse(y);
  residual_ = c;
  residual_.noalias() -= columns_.lazyProduct(y);
  apply_inverse(residual_);
  y += residual_;
}

void Basis::solve_transposed(const Eigen::VectorXd& g, Eigen::VectorXd& x) {
  x = g;
  apply_inverse_transposed(x);
  residual_ = g;
  residual_.noalias() -= columns_.transpose().lazyProduct(x);
  apply_inverse_transposed(residual_);
  x += residual_;
}

}  // namespace vinerow::controllers::lp
