#include "controllers/parts/solvers/tube_mpc.h"

#include <algorithm>
#include <cmath>

#include "engine/core/constants.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool is_soft(const TubeRow& row) {
  return row.kind == TubeRow::Kind::kState || row.kind == TubeRow::Kind::kTerminal;
}

bool frees_start(TubeLaw law) {
  return law == TubeLaw::kTube || law == TubeLaw::kPropagated;
}

TubeForm make_form(const TubeModel& model, const TubeSets& sets, const TubeCost& cost, TubeLaw law,
                   const std::string& who) {
  const Index n = model.A.rows(), m = model.B.cols();
  if (cost.Q.rows() != n || cost.Q.cols() != n || cost.R.rows() != m || cost.R.cols() != m ||
      cost.horizon < 1) {
    throw ConfigError(who + ": Q, R or the horizon do not fit the model");
  }
  const Result<MatrixXd> P = make_tube_weight(model, cost);
  if (!P) throw ConfigError(who + ": " + P.reason());
  return make_tube_form(model, sets, cost, *P, frees_start(law));
}

double largest(const VectorXd& values) {
  return values.size() == 0 ? 0.0 : values.cwiseAbs().maxCoeff();
}

}  // namespace

TubeMpc::TubeMpc(const TubeModel& model, const TubeSets& sets, const TubeCost& cost,
                 const TubeMpcSettings& settings, const std::string& who)
    : model_(model),
      sets_(sets),
      settings_(settings),
      horizon_(cost.horizon),
      form_(make_form(model, sets, cost, settings.law, who)),
      tube_rows_(frees_start(settings.law) ? static_cast<int>(sets.tube_rows.rows()) : 0),
      qp_(static_cast<int>(form_.H.rows()), static_cast<int>(form_.rows.rows()), settings.qp) {
  if (!qp_.set_hessian(form_.H)) {
    throw ConfigError(
        who +
        ": the Hessian of Q and R is not positive definite: weights are too far apart in size");
  }
  qp_.set_rows(form_.rows);
  const Index size = form_.H.rows(), rows = form_.rows.rows();
  for (Index r = 0; r < rows; ++r) {
    if (is_soft(form_.about[static_cast<std::size_t>(r)])) {
      qp_.soften_row(static_cast<int>(r), settings.soft_weight);
    }
  }
  f_.setZero(size);
  lower_.setConstant(size, -kInfinity);
  upper_.setConstant(size, kInfinity);
  row_lower_.setConstant(rows, -1.0);
  row_upper_.setConstant(rows, 1.0);
  y_.setZero(size);
  for (VectorXd* vector : {&z0_, &start_, &error_, &next_z_}) vector->setZero(states());
  for (VectorXd* vector : {&u_, &v0_}) vector->setZero(inputs());
  tube_values_.setZero(sets.tube_rows.rows());
  terminal_values_.setZero(sets.terminal_rows.rows());
  // The QP computes the products of its rows now, not in the first step.
  qp_.solve(f_, lower_, upper_, row_lower_, row_upper_);
  qp_.cold_start();
}

QpStatus TubeMpc::solve(const Eigen::Ref<const VectorXd>& x) {
  iterations_ = active_rows_ = 0;
  soft_violation_ = cost_ = tube_share_ = 0.0;
  // The sum is not finite if a number of x is not.
  if (!((0.0 * x).sum() == 0.0)) {
    fall_back(VectorXd::Zero(0));
    return QpStatus::kInvalidInput;
  }
  const bool is_fixed = choose_start(x);
  QpStatus status = QpStatus::kSolved;
  if (unconstrained_is_optimal(is_fixed)) {
    y_.setZero();
    y_.head(states()) = start_;
    cost_ = start_.dot(form_.H.topLeftCorner(states(), states()).lazyProduct(start_)) / 2.0;
    qp_.cold_start();
  } else {
    status = optimise(is_fixed);
  }
  if (status == QpStatus::kSolved) {
    finish(x);
  } else {
    fall_back(x);
  }
  return status;
}

/// Sets start_ to z_0, or if z_0 is free to the best one. @returns whether z_0 is given
bool TubeMpc::choose_start(const Eigen::Ref<const VectorXd>& x) {
  tube_values_.noalias() = sets_.tube_rows * x;
  start_ = x;
  if (!frees_start(settings_.law) || sets_.tube_rows.rows() == 0) return true;
  if (settings_.law == TubeLaw::kPropagated && has_next_) {
    error_ = x - next_z_;
    tube_values_.noalias() = sets_.tube_rows * error_;
    if (largest(tube_values_) <= 1.0) {
      start_ = next_z_;
      return true;
    }
    tube_values_.noalias() = sets_.tube_rows * x;
  }
  start_.setZero();
  return false;
}

/// True if v_i = K z_i from start_ is known to be the optimum.
bool TubeMpc::unconstrained_is_optimal(bool is_fixed) {
  if (!is_fixed) return largest(tube_values_) <= 1.0;  // start_ = 0 costs nothing
  if (!form_.is_decoupled) return false;
  terminal_values_.noalias() = sets_.terminal_rows * start_;
  return largest(terminal_values_) <= 1.0;
}

QpStatus TubeMpc::optimise(bool is_fixed) {
  const int n = states();
  if (is_fixed) {
    lower_.head(n) = upper_.head(n) = start_;
    row_lower_.head(tube_rows_).setConstant(-kInfinity);
    row_upper_.head(tube_rows_).setConstant(kInfinity);
  } else {
    lower_.head(n).setConstant(-kInfinity);
    upper_.head(n).setConstant(kInfinity);
    row_lower_.head(tube_rows_) = tube_values_.array() - 1.0;
    row_upper_.head(tube_rows_) = tube_values_.array() + 1.0;
  }
  const QpStatus status = qp_.solve(f_, lower_, upper_, row_lower_, row_upper_);
  iterations_ = qp_.iterations();
  if (status != QpStatus::kSolved) return status;
  y_ = qp_.x();
  cost_ = qp_.cost();
  for (const int constraint : qp_.active_set()) {
    if (constraint < n && is_fixed) continue;
    ++active_rows_;
    look_for_violation(constraint - qp_.variables());
  }
  return status;
}

/// Only active rows can be violated.
void TubeMpc::look_for_violation(int row) {
  if (row < 0 || !is_soft(form_.about[static_cast<std::size_t>(row)])) return;
  const double over = std::abs(form_.rows.row(row).dot(y_)) - 1.0;
  if (over <= soft_violation_) return;
  soft_violation_ = over;
  worst_row_ = form_.about[static_cast<std::size_t>(row)];
}

void TubeMpc::finish(const Eigen::Ref<const VectorXd>& x) {
  const int n = states(), m = inputs();
  z0_ = y_.head(n);
  v0_ = y_.segment(n, m);
  next_z_.noalias() = sets_.A_K * z0_;
  next_z_.noalias() += model_.B * v0_;
  has_next_ = true;
  v0_.noalias() += model_.K * z0_;
  error_ = x - z0_;
  tube_values_.noalias() = sets_.tube_rows * error_;
  tube_share_ = largest(tube_values_);
  if (settings_.law == TubeLaw::kPrinted) error_ = x;
  u_ = v0_;
  u_.noalias() += model_.K * error_;
}

/// @param x  length zero: unknown
void TubeMpc::fall_back(const Eigen::Ref<const VectorXd>& x) {
  cold_start();
  y_.setZero();
  u_.setZero();
  if (x.size() > 0) {
    u_.noalias() = model_.K * x;
    u_ = u_.cwiseMax(-model_.input_limit).cwiseMin(model_.input_limit);
  }
  v0_ = u_;
  z0_.setZero();
}

void TubeMpc::cold_start() {
  qp_.cold_start();
  has_next_ = false;
}

}  // namespace vinerow::controllers
