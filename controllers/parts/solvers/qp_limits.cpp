#include "controllers/parts/solvers/qp_limits.h"

#include <algorithm>

#include "engine/core/constants.h"

namespace vinerow::controllers::qp {
namespace {

// Share of the worst violation above which a constraint enters the shortlist, and its length.
// Measured on condensed MPC problems of 45 and 80 variables, where it halves the time of a cold
// start; shares from 0.05 to 0.8 and lengths from 4 to 16 perform about equally.
constexpr double kShortlistShare = 0.5;
constexpr std::size_t kShortlist = 8;
// With fewer constraints an evaluation of all of them costs no more.
constexpr int kFewConstraints = 48;

}  // namespace

Limits::Limits(const Form& form)
    : form_(&form), longest_shortlist_(form.constraints() < kFewConstraints ? 0 : kShortlist) {
  for (Eigen::VectorXd* vector : {&lower_, &upper_, &values_}) vector->setZero(form.constraints());
  score_.setZero(form.constraints());
  shortlist_.reserve(kShortlist);
}

Limits::Verdict Limits::take(const Input& lower, const Input& upper, const Input& row_lower,
                             const Input& row_upper) {
  lower_ << lower, row_lower;
  upper_ << upper, row_upper;
  const double *low = lower_.data(), *up = upper_.data();
  bool in_order = true;
  equalities_ = 0;
  for (Eigen::Index i = 0; i < lower_.size(); ++i) {
    in_order &= low[i] <= up[i] && low[i] < kInfinity && up[i] > -kInfinity;
    equalities_ += low[i] == up[i];
  }
  if (in_order) return Verdict::kFine;
  return lower_.hasNaN() || upper_.hasNaN() ? Verdict::kNotANumber : Verdict::kCrossed;
}

int Limits::max_violated(double y_length, const WorkingSet& set) {
  score_ = (values_.array() - upper_.array()).max(lower_.array() - values_.array()) *
               form_->inverse_length() -
           form_->scaled_tolerance();
  for (int i = 0; i < set.size(); ++i) score_[set[i].constraint] = -kInfinity;
  shortlist_.clear();
  const double worst = score_.maxCoeff();
  if (!(worst > kRounding * y_length)) return -1;
  const double *score = score_.data(), wanted = kShortlistShare * worst;
  int found = -1;
  for (int i = 0; i < form_->constraints(); ++i) {
    if (score[i] < wanted) continue;
    if (found < 0 && score[i] == worst) {
      found = i;
    } else if (shortlist_.size() < longest_shortlist_) {
      shortlist_.push_back(i);
    }
  }
  return found;
}

bool Limits::evaluate_shortlist(const Eigen::VectorXd& y, const WorkingSet& set) {
  if (shortlist_.empty()) return false;
  for (const int i : shortlist_) values_[i] = form_->value_at(i, y);
  for (int i = 0; i < set.size(); ++i) values_[set[i].constraint] = set.value(i, y);
  return true;
}

int Limits::max_violated_of_shortlist(double y_length, const WorkingSet& set) const {
  int found = -1;
  double worst = kRounding * y_length;
  for (const int i : shortlist_) {
    if (set.contains(i)) continue;
    const double score =
        std::max(over(i), under(i)) * form_->inverse_length()[i] - form_->scaled_tolerance()[i];
    if (score > worst) {
      worst = score;
      found = i;
    }
  }
  return found;
}

}  // namespace vinerow::controllers::qp
