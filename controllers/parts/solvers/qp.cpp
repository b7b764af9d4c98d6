#include "controllers/parts/solvers/qp.h"

#include <utility>

#include "controllers/parts/solvers/qp_ascent.h"
#include "controllers/parts/solvers/qp_form.h"
#include "controllers/parts/solvers/qp_limits.h"
#include "engine/core/check.h"

namespace vinerow::controllers {

const char* to_string(QpStatus status) {
  switch (status) {
    case QpStatus::kSolved:
      return "solved";
    case QpStatus::kInfeasible:
      return "infeasible";
    case QpStatus::kNotConvex:
      return "not convex";
    case QpStatus::kIterationLimit:
      return "iteration limit";
    case QpStatus::kInvalidInput:
      return "invalid input";
  }
  return "unknown";
}

struct QpSolver::Impl {
  Impl(int variables, int rows, const QpSettings& wanted)
      : settings(wanted),
        form(variables, rows, wanted.tolerance),
        limits(form),
        ascent(form, limits) {
    v.setZero(variables);
    x.setZero(variables);
    multipliers.setZero(form.constraints());
    active.reserve(static_cast<std::size_t>(form.constraints()));
  }

  using Input = Eigen::Ref<const Eigen::VectorXd>;

  int n() const { return form.variables(); }
  int m() const { return form.constraints() - form.variables(); }
  QpStatus check(const Input& f, qp::Limits::Verdict limits_verdict) const;
  QpStatus optimise(const Input& f);
  void publish();

  QpSettings settings;
  bool convex = false, rows_finite = true;
  qp::Form form;
  qp::Limits limits;
  qp::Ascent ascent;
  Eigen::VectorXd v;

  Eigen::VectorXd x, multipliers;
  double cost = 0.0;
  int iterations = 0;
  std::vector<int> active;
};

QpStatus QpSolver::Impl::check(const Input& f, qp::Limits::Verdict limits_verdict) const {
  if (!convex) return QpStatus::kNotConvex;
  const bool numbers = limits_verdict != qp::Limits::Verdict::kNotANumber;
  if (!numbers || !rows_finite || !f.allFinite()) return QpStatus::kInvalidInput;
  if (limits_verdict == qp::Limits::Verdict::kCrossed) return QpStatus::kInfeasible;
  return QpStatus::kSolved;
}

QpStatus QpSolver::Impl::optimise(const Input& f) {
  const bool form_changed = form.refresh();
  form.to_gradient(f, v);
  ascent.prepare(v, form_changed);
  const qp::Ascent::Outcome outcome = ascent.run(settings.max_iterations);
  iterations = ascent.changes();
  publish();
  switch (outcome) {
    case qp::Ascent::Outcome::kOptimal:
      return QpStatus::kSolved;
    case qp::Ascent::Outcome::kInfeasible:
      return QpStatus::kInfeasible;
    case qp::Ascent::Outcome::kLimit:
      return QpStatus::kIterationLimit;
    case qp::Ascent::Outcome::kNotANumber:
      return QpStatus::kInvalidInput;
  }
  return QpStatus::kIterationLimit;
}

void QpSolver::Impl::publish() {
  x = limits.values().head(n());
  const Eigen::VectorXd& y = ascent.y();
  cost = 0.5 * y.squaredNorm() + y.dot(v);
  for (int i = 0; i < ascent.set().size(); ++i) {
    const qp::Member& held = ascent.set()[i];
    multipliers[held.constraint] = held.multiplier;
    cost += 0.5 * held.softness * held.multiplier * held.multiplier;
    active.push_back(held.constraint);
    // Rounding must not move an input beyond its limit.
    if (held.constraint < n()) x[held.constraint] = held.limit;
  }
}

QpSolver::QpSolver(int variables, int rows, const QpSettings& settings)
    : impl_(new Impl(variables, rows, settings)) {}
QpSolver::~QpSolver() {
  delete impl_;
}
QpSolver::QpSolver(QpSolver&& other) noexcept : impl_(std::exchange(other.impl_, nullptr)) {}
QpSolver& QpSolver::operator=(QpSolver&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

int QpSolver::variables() const {
  return impl_->n();
}
int QpSolver::rows() const {
  return impl_->m();
}

bool QpSolver::set_hessian(const Eigen::Ref<const Eigen::MatrixXd>& H) {
  return impl_->convex = impl_->form.set_hessian(H);
}

void QpSolver::set_rows(const Eigen::Ref<const Eigen::MatrixXd>& A) {
  impl_->rows_finite = impl_->form.set_rows(A);
}

void QpSolver::soften_row(int row, double weight) {
  VINEROW_DEMAND(row >= 0 && row < impl_->m() && weight > 0.0);
  impl_->ascent.set_softness(impl_->n() + row, 1.0 / weight);
}

QpStatus QpSolver::solve(const Eigen::Ref<const Eigen::VectorXd>& f,
                         const Eigen::Ref<const Eigen::VectorXd>& lower,
                         const Eigen::Ref<const Eigen::VectorXd>& upper,
                         const Eigen::Ref<const Eigen::VectorXd>& row_lower,
                         const Eigen::Ref<const Eigen::VectorXd>& row_upper) {
  Impl& impl = *impl_;
  VINEROW_DEMAND(f.size() == impl.n() && lower.size() == impl.n() && upper.size() == impl.n() &&
                 row_lower.size() == impl.m() && row_upper.size() == impl.m());
  impl.x.setZero();
  impl.multipliers.setZero();
  impl.active.clear();
  impl.cost = 0.0;
  impl.iterations = 0;
  QpStatus status = impl.check(f, impl.limits.take(lower, upper, row_lower, row_upper));
  if (status == QpStatus::kSolved) status = impl.optimise(f);
  if (status != QpStatus::kSolved) impl.ascent.forget();
  return status;
}

void QpSolver::cold_start() {
  impl_->ascent.forget();
}

const Eigen::VectorXd& QpSolver::x() const {
  return impl_->x;
}
const Eigen::VectorXd& QpSolver::multipliers() const {
  return impl_->multipliers;
}
double QpSolver::cost() const {
  return impl_->cost;
}
int QpSolver::iterations() const {
  return impl_->iterations;
}
const std::vector<int>& QpSolver::active_set() const {
  return impl_->active;
}

}  // namespace vinerow::controllers
