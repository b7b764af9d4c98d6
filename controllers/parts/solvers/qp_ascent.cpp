#include "controllers/parts/solvers/qp_ascent.h"

#include <algorithm>
#include <cmath>

#include "engine/core/constants.h"

namespace vinerow::controllers::qp {
namespace {

// The problem in the variables of qp_form.h: minimise 1/2 |y + v|^2 subject to
// lower_i <= g_i y <= upper_i. The working set W (set_) holds its rows G_W at their limits b. With
// multipliers lambda and softnesses S = diag(1 / weight), stationarity and the soft limits are
//   y = -(v + G_W' lambda),   G_W y = b + S lambda,
// so the multipliers for which all members hold with equality solve
//   C lambda = -(b + G_W v),  C = G_W G_W' + S:  goal = C^-1 (-shifted_limit).
//
// run() repeats, with multipliers that always have the right sign:
//   1. aim() computes goal. On the way from the multipliers to goal the first member whose sign
//      would become wrong leaves W there (first_wrong_sign(), leave()).
//   2. If none leaves, the multipliers are goal and y is the minimum over W (find_point()).
//   3. The constraint with the largest violation enters W (enter()). If its row depends on the
//      members, g = sum_i combination_i g_i, it replaces the one whose multiplier reaches zero
//      first (exchange()). If there is no such member, no x satisfies all constraints.
//   4. If no constraint is violated, y is the optimum.
// Entering constraints raise the dual function, and no change of W lowers it.

// Smallest share of a dependent row that a member must have to be exchanged for it; smaller shares
// are rounding. Chosen.
constexpr double kSmallestShare = 1e-10;
// Softness below this share of the row's square would be lost in its pivot.
constexpr double kSmallestSoftness = 1e-12;
// Each removal adds its rounding to the factors; they are recomputed after this number. Chosen.
constexpr int kMaxRemovals = 200;
// Corrections of y with one working set. Chosen: each reduces the error by the relative accuracy of
// the factors.
constexpr int kMaxCorrections = 3;
// Share of the tolerance by which a member may miss its limit. Chosen: a corrected member is
// then well within the tolerance.
constexpr double kMemberTolerance = 0.1;

/// A multiplier of a member after a step; rounding must not change its sign.
double kept_sign(int side, double multiplier) {
  return side * multiplier < 0.0 ? 0.0 : multiplier;
}

}  // namespace

Ascent::Ascent(const Form& form, Limits& limits) : form_(&form), limits_(&limits), set_(form) {
  const int count = form.constraints();
  for (Eigen::VectorXd* vector : {&softness_, &rhs_, &goal_}) vector->setZero(count);
  y_.setZero(form.variables());
}

void Ascent::set_softness(int i, double softness) {
  softness_changed_ |= softness_[i] != softness;
  softness_[i] = softness;
}

Member Ascent::member(int constraint, int side) const {
  Member result;
  result.constraint = constraint;
  result.side = limits_->is_equality(constraint) ? 0 : side;
  result.limit = result.side < 0 ? limits_->lower(constraint) : limits_->upper(constraint);
  const double min_softness = kSmallestSoftness * form_->row_squared(constraint);
  if (softness_[constraint] > 0.0) result.softness = std::max(softness_[constraint], min_softness);
  return result;
}

/// Moves a member of the last run to the new limits. @returns false if it has no finite limit there
bool Ascent::keep(Member& old) const {
  const int side = old.side != 0 ? old.side : old.multiplier < 0.0 ? -1 : 1;
  const double multiplier = old.multiplier;
  old = member(old.constraint, side);
  old.multiplier = multiplier;
  return std::isfinite(old.limit);
}

void Ascent::prepare(const Eigen::VectorXd& v, bool form_changed) {
  v_ = &v;
  // Multipliers of the right sign are a valid start, whatever else has changed.
  int equalities = 0;
  for (int i = set_.size() - 1; i >= 0; --i) {
    if (keep(set_[i])) {
      equalities += set_[i].side == 0;
    } else {
      set_.remove(i);
    }
  }
  if (form_changed || softness_changed_ || set_.removals() > kMaxRemovals) set_.rebuild();
  softness_changed_ = false;
  if (equalities < limits_->equalities()) {
    for (int i = 0; i < form_->constraints(); ++i) {
      // A dependent equality is left out: either it holds as well, or it is found as violated.
      if (limits_->is_equality(i) && !set_.contains(i)) set_.append(member(i, 0));
    }
  }
  for (int i = 0; i < set_.size(); ++i) set_[i].shifted_limit = set_[i].limit + set_.value(i, v);
}

Ascent::Outcome Ascent::run(int max_changes) {
  changes_ = 0;
  ill_conditioned_ = false;
  limits_->clear_shortlist();
  aim();
  while (changes_ < max_changes) {
    double step = 0.0;
    const int leaving = first_wrong_sign(step);
    if (leaving >= 0) {
      leave(leaving, step);
      aim();
      continue;
    }
    for (int i = 0; i < set_.size(); ++i) set_[i].multiplier = goal_[i];
    if (!ill_conditioned_) find_point();
    y_length_ = y_.norm();
    if (!std::isfinite(y_length_)) return Outcome::kNotANumber;
    // Only a full evaluation can prove that the point is the optimum, or that no solution exists.
    const bool full = !limits_->evaluate_shortlist(y_, set_);
    if (full) limits_->evaluate(y_);
    if (corrections_ < kMaxCorrections && misses()) {
      ill_conditioned_ = true;
      ++corrections_;
      correct();
      continue;
    }
    const int violated = full ? limits_->max_violated(y_length_, set_)
                              : limits_->max_violated_of_shortlist(y_length_, set_);
    if (violated >= 0 && enter(violated)) {
      aim();
    } else if (full) {
      return violated < 0 ? Outcome::kOptimal : Outcome::kInfeasible;
    } else {
      limits_->clear_shortlist();
      // A failed exchange may have moved multipliers and dropped members.
      aim();
    }
  }
  return Outcome::kLimit;
}

/// goal = the multipliers for which all members hold with equality.
void Ascent::aim() {
  corrections_ = 0;
  for (int i = 0; i < set_.size(); ++i) rhs_[i] = -set_[i].shifted_limit;
  set_.solve(rhs_, goal_);
  if (!ill_conditioned_) return;
  find_point();
  correct();
}

/// y = -(v + G_W' goal).
void Ascent::find_point() {
  y_ = -*v_;
  for (int i = 0; i < set_.size(); ++i) {
    if (goal_[i] != 0.0) set_.add_row(i, -goal_[i], y_);
  }
}

/// Moves y onto the limits of the members: C delta = G_W y - b - S goal, goal += delta,
/// y -= G_W' delta. If large multipliers cancel in y, their rounding displaces y even if they are
/// accurate; so the step is applied to y as well as to the multipliers.
void Ascent::correct() {
  for (int i = 0; i < set_.size(); ++i) {
    rhs_[i] = set_.value(i, y_) - set_[i].limit - set_[i].softness * goal_[i];
  }
  set_.solve(rhs_, rhs_);
  for (int i = 0; i < set_.size(); ++i) {
    goal_[i] += rhs_[i];
    set_.add_row(i, -rhs_[i], y_);
  }
}

/// @returns true if a member misses its limit by more than kMemberTolerance of the tolerance
bool Ascent::misses() const {
  for (int i = 0; i < set_.size(); ++i) {
    const int c = set_[i].constraint;
    const double miss =
        limits_->values()[c] - set_[i].limit - set_[i].softness * set_[i].multiplier;
    const double allowed = kMemberTolerance * form_->scaled_tolerance()[c] + kRounding * y_length_;
    if (std::abs(miss) * form_->inverse_length()[c] > allowed) return true;
  }
  return false;
}

/// @returns the member whose multiplier is the first to change its sign on the way to the goal,
/// after the share `step` of it; -1 if none does
int Ascent::first_wrong_sign(double& step) const {
  int first = -1;
  step = kInfinity;
  for (int i = 0; i < set_.size(); ++i) {
    const double to = set_[i].side * goal_[i];
    if (!(to < 0.0)) continue;
    const double from = set_[i].side * set_[i].multiplier, share = from / (from - to);
    if (share < step) {
      step = share;
      first = i;
    }
  }
  return first;
}

/// Moves all multipliers by the share `step` towards the goal and removes member `leaving`.
void Ascent::leave(int leaving, double step) {
  for (int i = 0; i < set_.size(); ++i) {
    const double now = set_[i].multiplier;
    set_[i].multiplier = kept_sign(set_[i].side, now + step * (goal_[i] - now));
  }
  set_.remove(leaving);
  ++changes_;
}

/// Adds a violated constraint to the set. @returns false if no x satisfies all constraints
bool Ascent::enter(int constraint) {
  const double direction = limits_->over(constraint) > limits_->under(constraint) ? 1.0 : -1.0;
  const double length = 1.0 / form_->inverse_length()[constraint];
  Member added = member(constraint, static_cast<int>(direction));
  // A dependent row: exchange members until it is independent.
  while (!set_.append(added)) {
    double step = 0.0;
    const int leaving = exchange(direction, length, step);
    if (leaving < 0) return false;
    for (int i = 0; i < set_.size(); ++i) {
      const double moved = set_[i].multiplier - step * direction * set_.combination()[i];
      set_[i].multiplier = kept_sign(set_[i].side, moved);
    }
    added.multiplier += step * direction;
    set_.remove(leaving);
    ++changes_;
  }
  Member& entered = set_[set_.size() - 1];
  entered.multiplier = added.multiplier;
  entered.shifted_limit = added.limit + set_.value(set_.size() - 1, *v_);
  ++changes_;
  return true;
}

/// The member that a dependent row replaces: all multipliers move by -step * direction *
/// combination until the first of them is zero. @returns -1 if none reaches zero: then the
/// combination proves that the limits contradict each other (Farkas' lemma)
int Ascent::exchange(double direction, double row_length, double& step) const {
  int first = -1;
  double largest_share = 0.0;
  step = kInfinity;
  for (int i = 0; i < set_.size(); ++i) {
    const double rate = set_[i].side * direction * set_.combination()[i];
    const double share = rate / (row_length * form_->inverse_length()[set_[i].constraint]);
    if (!(share > kSmallestShare)) continue;
    const double steps = set_[i].side * set_[i].multiplier / rate;
    if (steps < step || (steps == step && share > largest_share)) {
      step = steps;
      largest_share = share;
      first = i;
    }
  }
  return first;
}

}  // namespace vinerow::controllers::qp
