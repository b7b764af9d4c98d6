#pragma once
/// Dual active-set iteration. The multipliers always have the right sign; with each violated
/// constraint that is added the dual function grows, until no constraint is violated.
///
/// Source: Arnstrom, Bemporad, Axehill, IEEE TAC 67(8), 2022, with the exchange step
/// of Goldfarb, Idnani, "A numerically stable dual method for solving strictly convex quadratic
/// programs", Math. Programming 27, 1983, where the new row depends on the active ones.

#include <Eigen/Core>

#include "controllers/parts/solvers/qp_form.h"
#include "controllers/parts/solvers/qp_limits.h"
#include "controllers/parts/solvers/qp_working_set.h"

namespace vinerow::controllers::qp {

class Ascent {
 public:
  enum class Outcome { kOptimal, kInfeasible, kLimit, kNotANumber };

  /// @param form, limits  must outlive this
  Ascent(const Form& form, Limits& limits);

  /// 1 / weight of constraint i, 0 if hard; takes effect with the next prepare().
  void set_softness(int i, double softness);

  /// Makes the active set of the last run the start of the next one.
  /// @param v  K' f; must outlive run()  @param form_changed  G has changed
  void prepare(const Eigen::VectorXd& v, bool form_changed);
  /// @param max_changes  of the active set
  Outcome run(int max_changes);
  void forget() { set_.clear(); }

  const WorkingSet& set() const { return set_; }
  const Eigen::VectorXd& y() const { return y_; }
  int changes() const { return changes_; }

 private:
  Member member(int constraint, int side) const;
  bool keep(Member& old) const;
  void aim();
  void find_point();
  void correct();
  bool misses() const;
  int first_wrong_sign(double& step) const;
  void leave(int leaving, double step);
  bool enter(int constraint);
  int exchange(double direction, double row_length, double& step) const;

  const Form* form_;
  Limits* limits_;
  WorkingSet set_;
  Eigen::VectorXd softness_;
  bool softness_changed_ = false;
  const Eigen::VectorXd* v_ = nullptr;
  Eigen::VectorXd y_, rhs_, goal_;
  double y_length_ = 0.0;
  int changes_ = 0;
  int corrections_ = 0;           // of y with the present members
  bool ill_conditioned_ = false;  // this run has needed a correction
};

}  // namespace vinerow::controllers::qp
