#include "controllers/parts/solvers/linear_mpc.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "controllers/parts/solvers/mpc_form.h"
#include "controllers/parts/solvers/mpc_prediction.h"
#include "engine/core/check.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// QpSolver caps the weight of a soft row at this, times 1 / (a' H^-1 a).
constexpr double kHeaviest = 1e12;

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

/// Shifts all columns by one to the left; the last one is repeated.
void move_up(MatrixXd& sequence) {
  for (Index k = 0; k + 1 < sequence.cols(); ++k) sequence.col(k) = sequence.col(k + 1);
}

/// The sum is NaN if a number is not finite, at a fraction of the cost of allFinite().
template <typename Matrix>
bool finite(const Matrix& matrix) {
  return (0.0 * matrix).sum() == 0.0;
}

double violation(const mpc::StateLimit& limit, double value) {
  if (std::isinf(limit.weight)) return 0.0;
  return std::max({0.0, value - limit.upper, limit.lower - value});
}

}  // namespace

struct LinearMpc::Impl {
  using Vector = Eigen::Ref<const VectorXd>;
  using Matrix = Eigen::Ref<const MatrixXd>;

  Impl(const LinearMpcProblem& wanted, const std::string& who, const QpSettings& settings);

  void forget();
  QpStatus optimise(const Matrix& input_reference, const Vector& input_before);
  void bound_first_input(const Vector& input_before);
  void place_rows();
  bool unreached_limits_hold() const;
  void keep_solution();
  void fall_back(QpStatus status, const Matrix& reference);
  void predict_states();

  LinearMpcProblem problem;
  mpc::Condensed form;
  mpc::Prediction prediction;
  Index n, m, N;
  QpSolver qp;
  double tolerance;
  std::vector<int> value_of_row;      // index of the prediction's value of a QP row
  VectorXd limit_lower, limit_upper;  // of the QP rows' values
  VectorXd softness;                  // 1 / weight of QP rows, as used by the QP

  MatrixXd f;             // m x N: gradient of the cost with respect to the inputs, at zero
  VectorXd lower, upper;  // Nm
  VectorXd row_lower, row_upper;
  MatrixXd inputs;

  double soft_violation = 0.0;
  // Data of the prediction, which is computed on the first call.
  VectorXd x, disturbance;
  MatrixXd states;
  bool predicted = true;
};

LinearMpc::Impl::Impl(const LinearMpcProblem& wanted, const std::string& who,
                      const QpSettings& settings)
    : problem(checked(wanted, who)),
      form(mpc::condense(problem)),
      prediction(problem, form),
      n(problem.A.rows()),
      m(problem.B.cols()),
      N(problem.horizon),
      qp(static_cast<int>(N * m), static_cast<int>(form.rows.rows()), settings),
      tolerance(settings.tolerance) {
  if (!qp.set_hessian(form.H)) {
    throw ConfigError(who + ": the condensed Hessian of Q, R and P is not positive definite");
  }
  qp.set_rows(form.rows);
  const Index rows = form.rows.rows();
  for (VectorXd* vector : {&limit_lower, &limit_upper, &softness, &row_lower, &row_upper}) {
    vector->setZero(rows);
  }
  const Eigen::LLT<MatrixXd> factor(form.H);
  for (Index i = 0; i < rows; ++i) {
    const mpc::StateLimit& limit = form.limits[static_cast<std::size_t>(i)];
    value_of_row.push_back(prediction.index_of(limit));
    limit_lower[i] = limit.lower;
    limit_upper[i] = limit.upper;
    if (std::isinf(limit.weight)) continue;
    qp.soften_row(static_cast<int>(i), limit.weight);
    const VectorXd row = form.rows.row(i);
    softness[i] = std::max(1.0 / limit.weight, row.dot(factor.solve(row)) / kHeaviest);
  }
  f.setZero(m, N);
  inputs.setZero(m, N);
  states.setZero(n, N + 1);
  x.setZero(n);
  disturbance.setZero(n);
  lower = problem.input_lower.replicate(N, 1);
  upper = problem.input_upper.replicate(N, 1);
  forget();
}

void LinearMpc::Impl::forget() {
  qp.cold_start();
  for (Index k = 0; k < N; ++k) {
    inputs.col(k).setZero();
    inputs.col(k) = inputs.col(k).cwiseMax(problem.input_lower).cwiseMin(problem.input_upper);
  }
  states.setZero();
  predicted = true;
  soft_violation = 0.0;
}

QpStatus LinearMpc::Impl::optimise(const Matrix& input_reference, const Vector& input_before) {
  prediction.find_gradient(input_reference, f);
  prediction.evaluate_limits();
  bound_first_input(input_before);
  place_rows();
  if (!unreached_limits_hold()) {
    qp.cold_start();
    return QpStatus::kInfeasible;
  }
  return qp.solve(Eigen::Map<const VectorXd>(f.data(), f.size()), lower, upper, row_lower,
                  row_upper);
}

void LinearMpc::Impl::bound_first_input(const Vector& input_before) {
  if (problem.rate_lower.size() == 0) return;
  for (Index i = 0; i < m; ++i) {
    lower[i] = std::max(problem.input_lower[i], input_before[i] + problem.rate_lower[i]);
    upper[i] = std::min(problem.input_upper[i], input_before[i] + problem.rate_upper[i]);
  }
}

void LinearMpc::Impl::place_rows() {
  const double* values = prediction.values();
  const int* place = value_of_row.data();
  for (Index i = 0; i < row_lower.size(); ++i) {
    const double given = values[place[i]];
    row_lower[i] = limit_lower[i] - given;
    row_upper[i] = limit_upper[i] - given;
  }
}

bool LinearMpc::Impl::unreached_limits_hold() const {
  for (const mpc::StateLimit& limit : form.unreached) {
    const double value = prediction.values()[prediction.index_of(limit)];
    if (std::isfinite(limit.weight)) continue;
    const double allowed = tolerance * std::max(1.0, std::abs(value));
    if (value > limit.upper + allowed || value < limit.lower - allowed) return false;
  }
  return true;
}

void LinearMpc::Impl::keep_solution() {
  // The QP may violate an input limit by its tolerance; the returned input must not.
  Eigen::Map<VectorXd>(inputs.data(), inputs.size()) = qp.x().cwiseMax(lower).cwiseMin(upper);
  // A violated limit is active, and its multiplier is the weight times the violation.
  soft_violation = 0.0;
  for (const int constraint : qp.active_set()) {
    if (constraint < N * m) continue;
    const double violated = std::abs(qp.multipliers()[constraint]) * softness[constraint - N * m];
    soft_violation = std::max(soft_violation, violated);
  }
  for (const mpc::StateLimit& limit : form.unreached) {
    const double value = prediction.values()[prediction.index_of(limit)];
    soft_violation = std::max(soft_violation, violation(limit, value));
  }
}

/// The inputs were clamped when they were computed, and the bounds are the same.
void LinearMpc::Impl::fall_back(QpStatus status, const Matrix& reference) {
  move_up(inputs);
  soft_violation = 0.0;
  if (status == QpStatus::kInvalidInput) {
    qp.cold_start();
    return;
  }
  predict_states();
  prediction.evaluate_limits(states, reference);
  for (const auto* limits : {&form.limits, &form.unreached}) {
    for (const mpc::StateLimit& limit : *limits) {
      const double value = prediction.values()[prediction.index_of(limit)];
      soft_violation = std::max(soft_violation, violation(limit, value));
    }
  }
}

void LinearMpc::Impl::predict_states() {
  if (predicted) return;
  prediction.predict(x, disturbance, inputs, states);
  predicted = true;
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
  const bool start_known = finite(x) && finite(disturbance);
  if (!start_known) {
    // The last prediction is needed below; it is computed now, before its inputs are lost.
    impl.predict_states();
    move_up(impl.states);
  }
  QpStatus status = QpStatus::kInvalidInput;
  if (start_known) {
    impl.x = x;
    impl.disturbance = disturbance;
    impl.predicted = false;
    if (finite(reference) && finite(input_reference) && finite(input_before)) {
      impl.prediction.predict_without_inputs(x, disturbance, reference);
      status = impl.optimise(input_reference, input_before);
    }
  }
  if (status == QpStatus::kSolved) {
    impl.keep_solution();
    return status;
  }
  impl.fall_back(status, reference);
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
  impl_->predict_states();
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

}  // namespace vinerow::controllers
