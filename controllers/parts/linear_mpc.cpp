#include "controllers/parts/linear_mpc.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/mpc_form.h"
#include "engine/core/check.h"
#include "engine/core/error.h"

namespace vinerow {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LinearMpcProblem checked(const LinearMpcProblem& problem, const std::string& who) {
  mpc::check(problem, who);
  LinearMpcProblem result = problem;
  const Index m = problem.B.cols();
  if (problem.input_lower.size() == 0) {
    result.input_lower.setConstant(m, -kInfinity);
    result.input_upper.setConstant(m, kInfinity);
  }
  return result;
}

/// Each column takes the place of the one before it; the last one stays.
void move_up(MatrixXd& sequence) {
  for (Index k = 0; k + 1 < sequence.cols(); ++k) sequence.col(k) = sequence.col(k + 1);
}

}  // namespace

struct LinearMpc::Impl {
  using Vector = Eigen::Ref<const VectorXd>;
  using Matrix = Eigen::Ref<const MatrixXd>;

  Impl(const LinearMpcProblem& wanted, const std::string& who, const QpSettings& settings);

  void forget();
  void predict_without_inputs(const Vector& x, const Vector& d);
  void find_gradient(const Matrix& reference, const Matrix& input_reference);
  void bound_first_input(const Vector& input_before);
  void place_rows(const Matrix& reference);
  bool unreached_limits_hold() const;
  QpStatus optimise(const Matrix& reference, const Matrix& input_reference, const Vector& before);
  void keep_solution();
  void predict(const Vector& x, const Vector& d);
  double violation(const mpc::StateLimit& limit, double shift) const;
  void find_soft_violation(bool solved);

  double shift(const mpc::StateLimit& limit, const Matrix& reference) const {
    return limit.relative ? form.F.dot(limit.F_row, reference.col(limit.step).data()) : 0.0;
  }

  LinearMpcProblem problem;
  mpc::Condensed form;
  Index n, m, N;
  // Cost gradients carry the factor 2 of |x|^2.
  mpc::SparseRows A, A_transposed, B, B_transposed, two_Q, two_P, minus_two_R;
  QpSolver qp;
  double tolerance;

  std::vector<int> limit_of_row;  // index in form.reached, -1 for rates

  MatrixXd free;                     // n x (N + 1): the states if all inputs were zero
  MatrixXd error;                    // n x (N + 1): free - reference
  VectorXd costate, costate_before;  // n: gradient of the cost by a state
  MatrixXd f;                        // m x N: gradient of the cost by the inputs, at zero
  VectorXd lower, upper;             // Nm
  VectorXd row_lower, row_upper;
  VectorXd shifts, unreached_shifts;  // F r of relative limits, else 0
  MatrixXd inputs, states;
  double soft_violation = 0.0;
};

LinearMpc::Impl::Impl(const LinearMpcProblem& wanted, const std::string& who,
                      const QpSettings& settings)
    : problem(checked(wanted, who)),
      form(mpc::condense(problem)),
      n(problem.A.rows()),
      m(problem.B.cols()),
      N(problem.horizon),
      A(problem.A),
      A_transposed(problem.A.transpose()),
      B(problem.B),
      B_transposed(problem.B.transpose()),
      two_Q(2.0 * problem.Q),
      two_P(2.0 * problem.P),
      minus_two_R(-2.0 * problem.R),
      qp(static_cast<int>(N * m), static_cast<int>(form.rows.rows()), settings),
      tolerance(settings.tolerance) {
  if (!qp.set_hessian(form.H)) {
    throw ConfigError(who + ": the condensed Hessian of Q, R and P is not positive definite");
  }
  qp.set_rows(form.rows);
  limit_of_row.assign(static_cast<std::size_t>(form.rows.rows()), -1);
  for (std::size_t i = 0; i < form.reached.size(); ++i) {
    qp.soften_row(form.reached[i].qp_row, form.reached[i].weight);
    limit_of_row[static_cast<std::size_t>(form.reached[i].qp_row)] = static_cast<int>(i);
  }
  free.setZero(n, N + 1);
  error.setZero(n, N + 1);
  states.setZero(n, N + 1);
  costate.setZero(n);
  costate_before.setZero(n);
  f.setZero(m, N);
  inputs.setZero(m, N);
  lower = problem.input_lower.replicate(N, 1);
  upper = problem.input_upper.replicate(N, 1);
  row_lower.setZero(form.rows.rows());
  row_upper.setZero(form.rows.rows());
  for (const mpc::RateLimit& rate : form.rates) {
    row_lower[rate.qp_row] = rate.lower;
    row_upper[rate.qp_row] = rate.upper;
  }
  shifts.setZero(static_cast<Index>(form.reached.size()));
  unreached_shifts.setZero(static_cast<Index>(form.unreached.size()));
  forget();
}

void LinearMpc::Impl::forget() {
  qp.cold_start();
  for (Index k = 0; k < N; ++k) {
    inputs.col(k).setZero();
    inputs.col(k) = inputs.col(k).cwiseMax(problem.input_lower).cwiseMin(problem.input_upper);
  }
  states.setZero();
  soft_violation = 0.0;
}

void LinearMpc::Impl::predict_without_inputs(const Vector& x, const Vector& d) {
  free.col(0) = x;
  for (Index k = 0; k < N; ++k) {
    free.col(k + 1) = d;
    A.add_product(free.col(k).data(), free.col(k + 1).data());
  }
}

/// The adjoint of the prediction: costate_k = 2 Q (x_k - r_k) + A' costate_{k+1}, and the gradient
/// by u_k is B' costate_{k+1} - 2 R v_k.
void LinearMpc::Impl::find_gradient(const Matrix& reference, const Matrix& input_reference) {
  error = free - reference;
  costate.setZero();
  two_P.add_product(error.col(N).data(), costate.data());
  f.setZero();
  for (Index k = N - 1; k >= 0; --k) {
    B_transposed.add_product(costate.data(), f.col(k).data());
    minus_two_R.add_product(input_reference.col(k).data(), f.col(k).data());
    if (k == 0) break;
    costate_before.setZero();
    two_Q.add_product(error.col(k).data(), costate_before.data());
    A_transposed.add_product(costate.data(), costate_before.data());
    costate.swap(costate_before);
  }
}

void LinearMpc::Impl::bound_first_input(const Vector& input_before) {
  if (problem.rate_lower.size() == 0) return;
  for (Index i = 0; i < m; ++i) {
    lower[i] = std::max(problem.input_lower[i], input_before[i] + problem.rate_lower[i]);
    upper[i] = std::min(problem.input_upper[i], input_before[i] + problem.rate_upper[i]);
  }
}

void LinearMpc::Impl::place_rows(const Matrix& reference) {
  Index i = 0;
  for (const mpc::StateLimit& limit : form.reached) {
    shifts[i] = shift(limit, reference);
    const double given = form.F.dot(limit.F_row, free.col(limit.step).data()) - shifts[i++];
    row_lower[limit.qp_row] = limit.lower - given;
    row_upper[limit.qp_row] = limit.upper - given;
  }
  i = 0;
  for (const mpc::StateLimit& limit : form.unreached) {
    unreached_shifts[i++] = shift(limit, reference);
  }
}

bool LinearMpc::Impl::unreached_limits_hold() const {
  Index i = 0;
  for (const mpc::StateLimit& limit : form.unreached) {
    const double value =
        form.F.dot(limit.F_row, free.col(limit.step).data()) - unreached_shifts[i++];
    if (std::isfinite(limit.weight)) continue;
    const double allowed = tolerance * std::max(1.0, std::abs(value));
    if (value > limit.upper + allowed || value < limit.lower - allowed) return false;
  }
  return true;
}

QpStatus LinearMpc::Impl::optimise(const Matrix& reference, const Matrix& input_reference,
                                   const Vector& before) {
  find_gradient(reference, input_reference);
  bound_first_input(before);
  place_rows(reference);
  if (!unreached_limits_hold()) {
    qp.cold_start();
    return QpStatus::kInfeasible;
  }
  return qp.solve(Eigen::Map<const VectorXd>(f.data(), f.size()), lower, upper, row_lower,
                  row_upper);
}

void LinearMpc::Impl::keep_solution() {
  // An input may be over a limit by the tolerance of the QP, the input that is given out not.
  Eigen::Map<VectorXd>(inputs.data(), inputs.size()) = qp.x().cwiseMax(lower).cwiseMin(upper);
}

void LinearMpc::Impl::predict(const Vector& x, const Vector& d) {
  states.col(0) = x;
  for (Index k = 0; k < N; ++k) {
    states.col(k + 1) = d;
    A.add_product(states.col(k).data(), states.col(k + 1).data());
    B.add_product(inputs.col(k).data(), states.col(k + 1).data());
  }
}

double LinearMpc::Impl::violation(const mpc::StateLimit& limit, double shift) const {
  if (std::isinf(limit.weight)) return 0.0;
  const double value = form.F.dot(limit.F_row, states.col(limit.step).data()) - shift;
  return std::max({0.0, value - limit.upper, limit.lower - value});
}

void LinearMpc::Impl::find_soft_violation(bool solved) {
  soft_violation = 0.0;
  if (solved) {
    // A limit that is violated is active.
    for (const int constraint : qp.active_set()) {
      if (constraint < N * m) continue;
      const int i = limit_of_row[static_cast<std::size_t>(constraint - N * m)];
      if (i < 0) continue;
      const mpc::StateLimit& limit = form.reached[static_cast<std::size_t>(i)];
      soft_violation = std::max(soft_violation, violation(limit, shifts[i]));
    }
  } else {
    Index i = 0;
    for (const mpc::StateLimit& limit : form.reached) {
      soft_violation = std::max(soft_violation, violation(limit, shifts[i++]));
    }
  }
  Index i = 0;
  for (const mpc::StateLimit& limit : form.unreached) {
    soft_violation = std::max(soft_violation, violation(limit, unreached_shifts[i++]));
  }
}

LinearMpc::LinearMpc(const LinearMpcProblem& problem, const std::string& who,
                     const QpSettings& settings)
    : impl_(std::make_unique<Impl>(problem, who, settings)) {}
LinearMpc::~LinearMpc() = default;
LinearMpc::LinearMpc(LinearMpc&&) noexcept = default;
LinearMpc& LinearMpc::operator=(LinearMpc&&) noexcept = default;

int LinearMpc::states() const {
  return static_cast<int>(impl_->n);
}
int LinearMpc::inputs() const {
  return static_cast<int>(impl_->m);
}
int LinearMpc::horizon() const {
  return static_cast<int>(impl_->N);
}

QpStatus LinearMpc::solve(const Eigen::Ref<const VectorXd>& x,
                          const Eigen::Ref<const MatrixXd>& reference,
                          const Eigen::Ref<const MatrixXd>& input_reference,
                          const Eigen::Ref<const VectorXd>& disturbance,
                          const Eigen::Ref<const VectorXd>& input_before) {
  Impl& impl = *impl_;
  VINEROW_DEMAND(x.size() == impl.n && disturbance.size() == impl.n);
  VINEROW_DEMAND(reference.rows() == impl.n && reference.cols() == impl.N + 1);
  VINEROW_DEMAND(input_reference.rows() == impl.m && input_reference.cols() == impl.N);
  VINEROW_DEMAND(input_before.size() == impl.m);
  const bool start_known = x.allFinite() && disturbance.allFinite();
  const bool finite = start_known && reference.allFinite() && input_reference.allFinite() &&
                      input_before.allFinite();
  QpStatus status = QpStatus::kInvalidInput;
  if (finite) {
    impl.predict_without_inputs(x, disturbance);
    status = impl.optimise(reference, input_reference, input_before);
  } else {
    impl.qp.cold_start();
  }
  const bool solved = status == QpStatus::kSolved;
  if (solved) {
    impl.keep_solution();
  } else {
    move_up(impl.inputs);
  }
  if (start_known) {
    impl.predict(x, disturbance);
  } else {
    move_up(impl.states);
  }
  impl.find_soft_violation(solved);
  return status;
}

void LinearMpc::cold_start() {
  impl_->forget();
}

Eigen::Ref<const VectorXd> LinearMpc::u() const {
  return impl_->inputs.col(0);
}
const MatrixXd& LinearMpc::inputs_ahead() const {
  return impl_->inputs;
}
const MatrixXd& LinearMpc::states_ahead() const {
  return impl_->states;
}
double LinearMpc::soft_violation() const {
  return impl_->soft_violation;
}
int LinearMpc::iterations() const {
  return impl_->qp.iterations();
}
double LinearMpc::cost() const {
  return impl_->qp.cost();
}

}  // namespace vinerow
