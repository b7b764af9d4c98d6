#include "controllers/parts/solvers/qp_working_set.h"

#include <algorithm>

#include "engine/core/check.h"

namespace vinerow::controllers::qp {
namespace {

// A pivot above this share of its row's square has lost at most four digits to cancellation.
constexpr double kPlainPivot = 1e-4;
// Squared sine of the angle below which a row counts as dependent on the others.
constexpr double kDependent = 1e-16;

}  // namespace

WorkingSet::WorkingSet(const Form& form) : form_(&form) {
  const int count = form.constraints();
  members_.reserve(static_cast<std::size_t>(count));
  kept_.reserve(static_cast<std::size_t>(count));
  inside_.assign(static_cast<std::size_t>(count), 0);
  factors_.setZero(offset(count));
  pivots_.setZero(count);
  for (Eigen::VectorXd* buffer :
       {&new_row_, &combination_, &correction_, &rank_one_, &rank_one_gain_}) {
    buffer->setZero(count);
  }
  residual_.setZero(form.variables());
}

void WorkingSet::add_row(int i, double factor, Eigen::VectorXd& y) const {
  const int constraint = (*this)[i].constraint, end = form_->end(constraint);
  Vector(y.data(), end) += factor * ConstVector(form_->row(constraint), end);
}

void WorkingSet::forward(Eigen::VectorXd& z) const {
  for (int i = 1; i < size(); ++i) {
    z[i] -= ConstVector(factor_row(i), i).dot(ConstVector(z.data(), i));
  }
}

void WorkingSet::backward(Eigen::VectorXd& z) const {
  for (int i = size() - 1; i > 0; --i) {
    Vector(z.data(), i) -= z[i] * ConstVector(factor_row(i), i);
  }
}

void WorkingSet::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& result) const {
  const int k = size();
  if (&rhs != &result) result.head(k) = rhs.head(k);
  forward(result);
  result.head(k).array() /= pivots_.head(k).array();
  backward(result);
}

bool WorkingSet::append(const Member& member) {
  VINEROW_ASSERT(!contains(member.constraint));
  const int k = size(), end = form_->end(member.constraint);
  const double* g = form_->row(member.constraint);
  for (int i = 0; i < k; ++i) {
    const int other = (*this)[i].constraint, common = std::min(end, form_->end(other));
    new_row_[i] = ConstVector(form_->row(other), common).dot(ConstVector(g, common));
  }
  forward(new_row_);
  const double square = form_->row_squared(member.constraint) + member.softness;
  double pivot = square;
  for (int i = 0; i < k; ++i) {
    const double z = new_row_[i];
    new_row_[i] = z / pivots_[i];
    pivot -= z * new_row_[i];
  }
  if (!(pivot > kPlainPivot * square)) pivot = corrected_pivot(member.constraint, member.softness);
  if (!(pivot > kDependent * square)) return false;
  Vector(factor_row(k), k) = new_row_.head(k);
  pivots_[k] = pivot;
  members_.push_back(member);
  inside_[static_cast<std::size_t>(member.constraint)] = 1;
  return true;
}

double WorkingSet::corrected_pivot(int constraint, double softness) {
  const int k = size(), end = form_->end(constraint);
  combination_.head(k) = new_row_.head(k);
  backward(combination_);
  residual_.setZero();
  residual_.head(end) = ConstVector(form_->row(constraint), end);
  for (int i = 0; i < k; ++i) add_row(i, -combination_[i], residual_);
  // One step of refinement. A soft member has a coordinate sqrt(softness) of its own.
  for (int i = 0; i < k; ++i) {
    correction_[i] = value(i, residual_) - (*this)[i].softness * combination_[i];
  }
  forward(correction_);
  correction_.head(k).array() /= pivots_.head(k).array();
  new_row_.head(k) += correction_.head(k);
  backward(correction_);
  combination_.head(k) += correction_.head(k);
  double pivot = softness;
  for (int i = 0; i < k; ++i) {
    add_row(i, -correction_[i], residual_);
    pivot += (*this)[i].softness * combination_[i] * combination_[i];
  }
  return pivot + residual_.squaredNorm();
}

void WorkingSet::remove(int position) {
  const int k = size(), rest = k - 1 - position;
  inside_[static_cast<std::size_t>((*this)[position].constraint)] = 0;
  members_.erase(members_.begin() + position);
  ++removals_;
  for (int i = 0; i < rest; ++i) rank_one_[i] = factor_row(position + 1 + i)[position];
  double gain = pivots_[position];
  // The removed row's contribution to the rows after it, `gain` w w', is added to their factors:
  // Gill, Golub, Murray, Saunders, "Methods for modifying matrix factorizations", 1974, method C1.
  // It only adds, so no digits are lost.
  for (int i = 0; i < rest; ++i) {
    const double* from = factor_row(position + 1 + i);
    double* to = factor_row(position + i);
    Vector(to, position) = ConstVector(from, position);
    double w = rank_one_[i];
    for (int j = 0; j < i; ++j) {
      const double entry = from[position + 1 + j];
      w -= rank_one_[j] * entry;
      to[position + j] = entry + rank_one_gain_[j] * w;
    }
    rank_one_[i] = w;
    const double old_pivot = pivots_[position + 1 + i], new_pivot = old_pivot + gain * w * w;
    rank_one_gain_[i] = gain * w / new_pivot;
    gain *= old_pivot / new_pivot;
    pivots_[position + i] = new_pivot;
  }
}

void WorkingSet::clear() {
  for (const Member& member : members_) inside_[static_cast<std::size_t>(member.constraint)] = 0;
  members_.clear();
  removals_ = 0;
}

void WorkingSet::rebuild() {
  kept_ = members_;
  clear();
  for (const Member& member : kept_) append(member);
}

}  // namespace vinerow::controllers::qp
