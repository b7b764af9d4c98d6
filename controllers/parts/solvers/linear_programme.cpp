#include "controllers/parts/solvers/linear_programme.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"

namespace vinerow::controllers {
namespace {

// Cost vectors and rows have length one here, so these numbers are relative.
constexpr double kPricing = 0.01;     // of the tolerance: allowed violation of a row
constexpr double kZero = 1e-13;       // smaller multipliers are rounding
constexpr double kSmallPivot = 1e-9;  // of the largest entry of the direction
constexpr double kProgress = 1e-12;   // a shorter dual step is no progress
constexpr double kGoldenPart = 0.6180339887498949;

}  // namespace

const char* to_string(LpStatus status) {
  switch (status) {
    case LpStatus::kSolved:
      return "solved";
    case LpStatus::kInfeasible:
      return "infeasible";
    case LpStatus::kUnbounded:
      return "unbounded";
    case LpStatus::kIterationLimit:
      return "iteration limit";
    case LpStatus::kInvalidInput:
      return "invalid input";
  }
  return "unknown";
}

LinearProgramme::LinearProgramme(int variables, int max_rows, const LpSettings& settings)
    : n_(variables),
      settings_(settings),
      rows_(variables, max_rows),
      factors_(variables),
      basis_(static_cast<std::size_t>(variables)),
      excluded_(static_cast<std::size_t>(max_rows)),
      cost_(Eigen::VectorXd::Zero(variables)),
      limits_(Eigen::VectorXd::Zero(variables)),
      y_(Eigen::VectorXd::Zero(variables)),
      z_(Eigen::VectorXd::Zero(variables)),
      direction_(Eigen::VectorXd::Zero(variables)),
      slack_(Eigen::VectorXd::Zero(max_rows)),
      entering_(Eigen::VectorXd::Zero(variables)),
      ray_(Eigen::VectorXd::Zero(variables)),
      x_(Eigen::VectorXd::Zero(variables)),
      multipliers_(Eigen::VectorXd::Zero(max_rows)) {
  VINEROW_DEMAND(variables >= 1 && max_rows >= 0);
}

void LinearProgramme::set_rows(const Eigen::Ref<const Eigen::MatrixXd>& F,
                               const Eigen::Ref<const Eigen::VectorXd>& g) {
  rows_.set(F, g);
}

void LinearProgramme::set_limit(int row, double g) {
  rows_.set_limit(row, g);
}

LpStatus LinearProgramme::maximise(const Eigen::Ref<const Eigen::VectorXd>& c) {
  VINEROW_DEMAND(c.size() == n_);
  iterations_ = 0;
  x_.setZero();
  multipliers_.setZero();
  value_ = std::numeric_limits<double>::quiet_NaN();
  if (!c.allFinite() || !rows_.valid()) return LpStatus::kInvalidInput;
  if (const int row = rows_.contradiction(); row != kNone) {
    multipliers_[row] = 1.0;
    return finish(LpStatus::kInfeasible);
  }
  cost_ = c.cwiseProduct(rows_.scale());
  const double length = cost_.stableNorm();
  if (length == 0.0) return maximise_nothing();
  cost_ /= length;
  switch (run()) {
    case Outcome::kOptimum:
      for (int k = 0; k < n_; ++k) {
        const int row = basis_[static_cast<std::size_t>(k)];
        if (row >= 0) multipliers_[row] = length * y_[k] / rows_.length(row);
      }
      x_ = z_.cwiseProduct(rows_.scale());
      value_ = c.dot(x_);
      return LpStatus::kSolved;
    case Outcome::kNoPrimal:
      return finish(LpStatus::kInfeasible);
    case Outcome::kStopped:
      return finish(LpStatus::kIterationLimit);
    case Outcome::kNoDual:
      break;
  }
  // c'x is unbounded on the rows; whether any x satisfies them is checked separately.
  ray_ = z_.cwiseProduct(rows_.scale());
  const LpStatus feasible = maximise_nothing();
  if (feasible != LpStatus::kSolved) return feasible;
  x_ = ray_;
  return finish(LpStatus::kUnbounded);
}

LpStatus LinearProgramme::maximise_nothing() {
  // A cost that is a positive combination of the rows has a dual solution, so the set is empty or
  // the optimum is one of its points. One row outweighs all others together, so that they cannot
  // cancel it; the others share uneven weights to avoid ties.
  cost_.setZero();
  bool first = true;
  for (int i = 0; i < rows_.count(); ++i) {
    if (!rows_.in_force(i)) continue;
    const double turns = kGoldenPart * i;
    const double share = 0.25 * (1.0 + turns - std::floor(turns)) / rows_.count();
    cost_ += (first ? 1.0 : share) * rows_.row(i);
    first = false;
  }
  const double length = cost_.norm();
  z_.setZero();
  Outcome outcome = Outcome::kOptimum;
  if (length > 0.0) {
    cost_ /= length;
    outcome = run();
  }
  if (outcome == Outcome::kNoPrimal) return finish(LpStatus::kInfeasible);
  if (outcome != Outcome::kOptimum) return finish(LpStatus::kIterationLimit);
  x_ = z_.cwiseProduct(rows_.scale());
  value_ = 0.0;
  return LpStatus::kSolved;
}

LpStatus LinearProgramme::finish(LpStatus status) {
  if (status == LpStatus::kInfeasible) value_ = -std::numeric_limits<double>::infinity();
  if (status == LpStatus::kUnbounded) value_ = std::numeric_limits<double>::infinity();
  return status;
}

LinearProgramme::Outcome LinearProgramme::run() {
  for (int i = 0; i < rows_.count(); ++i) {
    excluded_[static_cast<std::size_t>(i)] = !rows_.in_force(i);
  }
  for (int j = 0; j < n_; ++j) {
    basis_[static_cast<std::size_t>(j)] = -1 - j;
    factors_.column(j).setZero();
    factors_.column(j)[j] = cost_[j] < 0.0 ? -1.0 : 1.0;
  }
  stalled_ = 0;
  const Outcome outcome = phase_one();
  if (outcome != Outcome::kOptimum) return outcome;
  if (!drive_out_artificials()) return Outcome::kStopped;
  stalled_ = 0;
  return phase_two();
}

LinearProgramme::Outcome LinearProgramme::phase_one() {
  for (; iterations_ < settings_.max_iterations; ++iterations_) {
    if (!refactor()) return Outcome::kStopped;
    double missing = 0.0;  // part of the cost in artificial columns
    for (int k = 0; k < n_; ++k) {
      limits_[k] = artificial(k) ? 1.0 : 0.0;
      missing += limits_[k] * y_[k];
    }
    if (missing <= kZero) return Outcome::kOptimum;
    factors_.solve_transposed(limits_, z_);
    rows_.multiply(z_, slack_);
    const double size = z_.norm();
    const int row = entering_row(kPricing * settings_.tolerance * size, 0.0);
    if (row == kNone) {
      // No row limits the direction z, along which the cost grows if artificial columns remain.
      return missing > settings_.tolerance * size ? Outcome::kNoDual : Outcome::kOptimum;
    }
    if (!enter(row, true)) return Outcome::kStopped;
  }
  return Outcome::kStopped;
}

bool LinearProgramme::drive_out_artificials() {
  for (int k = 0; k < n_; ++k) {
    if (!artificial(k)) continue;
    limits_.setZero();
    limits_[k] = 1.0;
    factors_.solve_transposed(limits_, z_);
    rows_.multiply(z_, slack_);
    int row = kNone;
    double largest = kSmallPivot * z_.norm();
    for (int i = 0; i < rows_.count(); ++i) {
      if (excluded_[static_cast<std::size_t>(i)] || std::abs(slack_[i]) <= largest) continue;
      largest = std::abs(slack_[i]);
      row = i;
    }
    // Without such a row all rows are orthogonal to this direction, and the artificial column
    // stays, at zero.
    if (row == kNone) continue;
    replace(k, row);
    if (!refactor()) return false;
  }
  return true;
}

LinearProgramme::Outcome LinearProgramme::phase_two() {
  for (; iterations_ < settings_.max_iterations; ++iterations_) {
    if (!refactor()) return Outcome::kStopped;
    for (int k = 0; k < n_; ++k) {
      limits_[k] = artificial(k) ? 0.0 : rows_.g()[basis_[static_cast<std::size_t>(k)]];
    }
    factors_.solve_transposed(limits_, z_);
    rows_.multiply(z_, slack_);
    slack_.head(rows_.count()) -= rows_.g().head(rows_.count());
    const double size = z_.norm();
    const double allowed = kPricing * settings_.tolerance;
    const int row = entering_row(allowed * size, allowed);
    if (row == kNone) return Outcome::kOptimum;
    const double violation = slack_[row];
    if (enter(row, false)) continue;
    // No multiplier falls: the row is minus a positive combination of rows of the basis, and these
    // contradict it. By less than the tolerance it is a repeated equality, satisfied as well as
    // possible.
    const double tolerance = settings_.tolerance * (size + std::abs(rows_.g()[row]));
    if (violation > tolerance * (1.0 + direction_.cwiseAbs().sum())) {
      multipliers_[row] = 1.0 / rows_.length(row);
      for (int k = 0; k < n_; ++k) {
        const int other = basis_[static_cast<std::size_t>(k)];
        if (other >= 0) multipliers_[other] = std::max(0.0, -direction_[k]) / rows_.length(other);
      }
      return Outcome::kNoPrimal;
    }
    excluded_[static_cast<std::size_t>(row)] = 1;
  }
  return Outcome::kStopped;
}

bool LinearProgramme::refactor() {
  if (!factors_.factor()) return false;
  factors_.solve(cost_, y_);
  y_ = y_.cwiseMax(0.0);
  return true;
}

bool LinearProgramme::bland() const {
  return stalled_ > 2 * n_ + 10;
}

int LinearProgramme::entering_row(double allowed, double allowed_of_limit) const {
  int best = kNone;
  double largest = 0.0;
  for (int i = 0; i < rows_.count(); ++i) {
    if (excluded_[static_cast<std::size_t>(i)] || slack_[i] <= largest) continue;
    if (!(slack_[i] > allowed + allowed_of_limit * std::abs(rows_.g()[i]))) continue;
    if (bland()) return i;
    largest = slack_[i];
    best = i;
  }
  return best;
}

bool LinearProgramme::enter(int row, bool artificials_may_leave) {
  entering_ = rows_.row(row);
  factors_.solve(entering_, direction_);
  const int place = leaving_place(artificials_may_leave);
  if (place == kNone) return false;
  stalled_ = y_[place] > kProgress * direction_[place] ? 0 : stalled_ + 1;
  replace(place, row);
  return true;
}

int LinearProgramme::leaving_place(bool artificials_may_leave) const {
  const double min_pivot = kSmallPivot * direction_.cwiseAbs().maxCoeff();
  const auto candidate = [&](int k) {
    return direction_[k] > min_pivot && (artificials_may_leave || !artificial(k));
  };
  // Two passes (Harris, "Pivot selection methods of the Devex LP code", Math. Prog. 5, 1973): the
  // longest step if multipliers may fall below zero by rounding, then the largest pivot of those
  // that limit it.
  double step = std::numeric_limits<double>::infinity();
  const double harris_tolerance = bland() ? 0.0 : kZero;
  for (int k = 0; k < n_; ++k) {
    if (candidate(k)) step = std::min(step, (y_[k] + harris_tolerance) / direction_[k]);
  }
  int best = kNone;
  for (int k = 0; k < n_; ++k) {
    if (!candidate(k) || y_[k] > step * direction_[k]) continue;
    const auto order = [&](int place) { return basis_[static_cast<std::size_t>(place)]; };
    const bool better =
        best == kNone || (bland() ? order(k) < order(best) : direction_[k] > direction_[best]);
    if (better) best = k;
  }
  return best;
}

void LinearProgramme::replace(int place, int row) {
  const int before = basis_[static_cast<std::size_t>(place)];
  if (before >= 0) excluded_[static_cast<std::size_t>(before)] = 0;
  excluded_[static_cast<std::size_t>(row)] = 1;
  basis_[static_cast<std::size_t>(place)] = row;
  factors_.column(place) = rows_.row(row);
}

}  // namespace vinerow::controllers
