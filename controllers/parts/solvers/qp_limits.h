#pragma once
/// Limits of all constraints of a programme, and search for those that a point violates.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/solvers/qp_form.h"
#include "controllers/parts/solvers/qp_working_set.h"

namespace vinerow::controllers::qp {

/// Rounding error of a value g y, relative to |g| |y|.
inline constexpr double kRounding = 64.0 * 2.220446049250313e-16;

class Limits {
 public:
  enum class Verdict { kFine, kCrossed, kNotANumber };
  using Input = Eigen::Ref<const Eigen::VectorXd>;

  /// @param form  must outlive this
  explicit Limits(const Form& form);

  /// Limits of the n bounds and the m rows. +infinity below and -infinity above count as crossed.
  Verdict take(const Input& lower, const Input& upper, const Input& row_lower,
               const Input& row_upper);
  int equalities() const { return equalities_; }
  bool is_equality(int i) const { return lower_[i] == upper_[i]; }
  double lower(int i) const { return lower_[i]; }
  double upper(int i) const { return upper_[i]; }

  /// Values of all constraints at y.
  void evaluate(const Eigen::VectorXd& y) { form_->values_at(y, values_); }
  const Eigen::VectorXd& values() const { return values_; }
  /// Distance of value i above its upper limit, and below its lower limit.
  double over(int i) const { return values_[i] - upper_[i]; }
  double under(int i) const { return lower_[i] - values_[i]; }

  /// After evaluate(y): the constraint outside `set` with the largest violation in the metric of H;
  /// -1 if all hold. Others with nearly the same violation are kept as the shortlist.
  int max_violated(double y_length, const WorkingSet& set);
  /// Values of the shortlist and of the set at y: few products where evaluate() takes n + m.
  /// @returns false if the shortlist is empty
  bool evaluate_shortlist(const Eigen::VectorXd& y, const WorkingSet& set);
  /// After evaluate_shortlist(y): as max_violated(), among the shortlist. -1 does not imply that
  /// the others hold.
  int max_violated_of_shortlist(double y_length, const WorkingSet& set) const;
  void clear_shortlist() { shortlist_.clear(); }

 private:
  const Form* form_;
  Eigen::VectorXd lower_, upper_, values_;
  Eigen::ArrayXd score_;
  std::vector<int> shortlist_;
  std::size_t longest_shortlist_;
  int equalities_ = 0;
};

}  // namespace vinerow::controllers::qp
