#pragma once
/// Constraints that hold with equality, and the factors L D L' of their Gram matrix
///   C = G_W G_W' + diag(softness),
/// updated by one row at a time. A constraint that depends linearly on the others is not added; its
/// combination of them determines which one it can replace.
///
/// Recursive L D L' of a dual active-set method: Arnstrom, Bemporad, Axehill, IEEE TAC 67(8), 2022.
/// The pivot of a nearly dependent row is measured on the row itself (corrected
/// semi-normal equations: Bjorck, "Stability analysis of the method of semi-normal equations",
/// Linear Algebra Appl. 88, 1987). So angles down to 1e-8 rad are distinguished from zero, which
/// the Gram matrix alone would lose. Gram matrix alone would lose.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/solvers/qp_form.h"

namespace vinerow::controllers::qp {

struct Member {
  int constraint = 0;
  int side = 0;           ///< +1 at the upper limit, -1 at the lower one, 0 for an equality
  double limit = 0.0;     ///< the value at which it is held
  double softness = 0.0;  ///< 1 / weight, 0 if hard
  double multiplier = 0.0;
  double shifted_limit = 0.0;  ///< limit + g v: the right-hand side for C and the multipliers
};

class WorkingSet {
 public:
  /// @param form  must outlive this
  explicit WorkingSet(const Form& form);

  int size() const { return static_cast<int>(members_.size()); }
  Member& operator[](int i) { return members_[static_cast<std::size_t>(i)]; }
  const Member& operator[](int i) const { return members_[static_cast<std::size_t>(i)]; }
  bool contains(int constraint) const { return inside_[static_cast<std::size_t>(constraint)] != 0; }

  /// @returns false, and changes nothing but combination(), if the row depends on the members
  bool append(const Member& member);
  /// Of the refused row g: g = sum_i combination[i] g_i.
  const Eigen::VectorXd& combination() const { return combination_; }
  void remove(int position);
  void clear();
  /// Recomputes the factors; members that depend on earlier ones are dropped.
  void rebuild();
  /// Rows removed since the last rebuild(): each adds its rounding to the factors.
  int removals() const { return removals_; }

  /// result[0, size) = C^-1 rhs; both have room for size() numbers and may be the same.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& result) const;
  /// g_i . y of member i
  double value(int i, const Eigen::VectorXd& y) const {
    return form_->value_at((*this)[i].constraint, y);
  }
  /// y += factor g_i
  void add_row(int i, double factor, Eigen::VectorXd& y) const;

 private:
  double* factor_row(int i) { return factors_.data() + offset(i); }
  const double* factor_row(int i) const { return factors_.data() + offset(i); }
  static Eigen::Index offset(int i) { return static_cast<Eigen::Index>(i) * (i - 1) / 2; }
  void forward(Eigen::VectorXd& z) const;
  void backward(Eigen::VectorXd& z) const;
  /// Improves new_row_ and combination_ for the row of `constraint`. @returns its pivot
  double corrected_pivot(int constraint, double softness);

  const Form* form_;
  std::vector<Member> members_;
  std::vector<char> inside_;
  Eigen::VectorXd factors_;  // strict lower triangle of L, row after row
  Eigen::VectorXd pivots_;   // D
  Eigen::VectorXd new_row_, combination_, residual_, correction_, rank_one_, rank_one_gain_;
  std::vector<Member> kept_;
  int removals_ = 0;
};

}  // namespace vinerow::controllers::qp
