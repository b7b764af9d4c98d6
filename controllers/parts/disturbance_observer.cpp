#include "controllers/parts/disturbance_observer.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>

#include "controllers/parts/riccati.h"
#include "engine/core/check.h"
#include "engine/core/error.h"

namespace vinerow {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class Checker {
 public:
  explicit Checker(const std::string& who) : who_(who) {}

  void matrix(const char* name, const MatrixXd& M, Index rows, Index columns) const {
    if (M.rows() != rows || M.cols() != columns) {
      fail(fmt::format("{} is {} x {}, must be {} x {}", name, M.rows(), M.cols(), rows, columns));
    }
    if (!M.allFinite()) fail(fmt::format("{} holds a number that is not finite", name));
  }

  void deviations(const char* name, const VectorXd& values, Index size, bool may_be_zero) const {
    if (values.size() != size) {
      fail(fmt::format("{} has {} numbers, must have {}", name, values.size(), size));
    }
    for (Index i = 0; i < size; ++i) {
      if (std::isfinite(values[i]) && (may_be_zero ? values[i] >= 0.0 : values[i] > 0.0)) continue;
      fail(fmt::format("{} {} = {:g}, must be {} 0", name, i, values[i], may_be_zero ? ">=" : ">"));
    }
  }

  [[noreturn]] void fail(const std::string& what) const { throw ConfigError(who_ + ": " + what); }

 private:
  const std::string& who_;
};

void check(const DisturbanceModel& model, const Checker& checker) {
  const Index n = model.A.rows(), disturbances = model.E.cols(), outputs = model.C.rows();
  if (n == 0) checker.fail("A has no rows");
  if (disturbances == 0) checker.fail("E has no columns");
  if (outputs == 0) checker.fail("C has no rows");
  checker.matrix("A", model.A, n, n);
  checker.matrix("B", model.B, n, model.B.cols());
  checker.matrix("E", model.E, n, disturbances);
  checker.matrix("C", model.C, outputs, n);
  checker.deviations("state_noise", model.state_noise, n, true);
  checker.deviations("disturbance_noise", model.disturbance_noise, disturbances, false);
  checker.deviations("measurement_noise", model.measurement_noise, outputs, false);
  // Muske and Badgwell's condition for the augmented model to be detectable.
  MatrixXd M = MatrixXd::Zero(n + outputs, n + disturbances);
  M.topLeftCorner(n, n) = model.A - MatrixXd::Identity(n, n);
  M.topRightCorner(n, disturbances) = model.E;
  M.bottomLeftCorner(outputs, n) = model.C;
  // Columns of one length: whether a disturbance is seen is no matter of its unit.
  for (Index j = 0; j < M.cols(); ++j) {
    if (M.col(j).norm() > 0.0) M.col(j).normalize();
  }
  Eigen::ColPivHouseholderQR<MatrixXd> qr(M);
  qr.setThreshold(1e-10);
  if (qr.rank() == n + disturbances) return;
  checker.fail(
      fmt::format("the rank of [A - I, E; C, 0] is {}, must be {}: the outputs do not tell the "
                  "disturbances from the state",
                  qr.rank(), n + disturbances));
}

}  // namespace

struct DisturbanceObserver::Impl {
  MatrixXd A, B, E, C;  // of the augmented state (x, d), but for E
  MatrixXd gain;
  double error_radius = 0.0;
  VectorXd z, predicted, innovation;
  VectorXd x, d, disturbance;

  void publish() {
    x = z.head(x.size());
    d = z.tail(d.size());
    disturbance.noalias() = E * d;
  }
};

DisturbanceObserver::DisturbanceObserver(const DisturbanceModel& model, const std::string& who)
    : impl_(std::make_unique<Impl>()) {
  const Checker checker(who);
  check(model, checker);
  const Index n = model.A.rows(), disturbances = model.E.cols(), outputs = model.C.rows();
  Impl& impl = *impl_;
  impl.A.setIdentity(n + disturbances, n + disturbances);
  impl.A.topLeftCorner(n, n) = model.A;
  impl.A.topRightCorner(n, disturbances) = model.E;
  impl.B.setZero(n + disturbances, model.B.cols());
  impl.B.topRows(n) = model.B;
  impl.E = model.E;
  impl.C.setZero(outputs, n + disturbances);
  impl.C.leftCols(n) = model.C;
  VectorXd noise(n + disturbances);
  noise << model.state_noise, model.disturbance_noise;
  const MatrixXd W = noise.cwiseAbs2().asDiagonal();
  const MatrixXd V = model.measurement_noise.cwiseAbs2().asDiagonal();
  // The filter is the dual of the regulator of (A', C').
  const Result<MatrixXd> P = solve_dare(impl.A.transpose(), impl.C.transpose(), W, V);
  if (!P) checker.fail("no steady-state Kalman filter for (A', C', noise): " + P.reason());
  const MatrixXd CP = impl.C * *P;
  impl.gain = MatrixXd(CP * impl.C.transpose() + V).ldlt().solve(CP).transpose();
  impl.error_radius = spectral_radius(impl.A - impl.gain * impl.C * impl.A);
  impl.z.setZero(n + disturbances);
  impl.predicted.setZero(n + disturbances);
  impl.innovation.setZero(outputs);
  impl.x.setZero(n);
  impl.d.setZero(disturbances);
  impl.disturbance.setZero(n);
}

DisturbanceObserver::~DisturbanceObserver() = default;
DisturbanceObserver::DisturbanceObserver(DisturbanceObserver&&) noexcept = default;
DisturbanceObserver& DisturbanceObserver::operator=(DisturbanceObserver&&) noexcept = default;

void DisturbanceObserver::reset(const Eigen::Ref<const VectorXd>& x,
                                const Eigen::Ref<const VectorXd>& d) {
  VINEROW_DEMAND(x.size() == impl_->x.size() && d.size() == impl_->d.size());
  impl_->z << x, d;
  impl_->publish();
}

bool DisturbanceObserver::step(const Eigen::Ref<const VectorXd>& measured,
                               const Eigen::Ref<const VectorXd>& input_before) {
  Impl& impl = *impl_;
  VINEROW_DEMAND(measured.size() == impl.C.rows() && input_before.size() == impl.B.cols());
  if (!input_before.allFinite()) return false;
  impl.predicted.noalias() = impl.A * impl.z;
  impl.predicted.noalias() += impl.B * input_before;
  impl.z = impl.predicted;
  const bool seen = measured.allFinite();
  if (seen) {
    impl.innovation = measured;
    impl.innovation.noalias() -= impl.C * impl.predicted;
    impl.z.noalias() += impl.gain * impl.innovation;
  }
  impl.publish();
  return seen;
}

const VectorXd& DisturbanceObserver::x() const {
  return impl_->x;
}
const VectorXd& DisturbanceObserver::d() const {
  return impl_->d;
}
const VectorXd& DisturbanceObserver::disturbance() const {
  return impl_->disturbance;
}
const MatrixXd& DisturbanceObserver::gain() const {
  return impl_->gain;
}
double DisturbanceObserver::error_radius() const {
  return impl_->error_radius;
}

}  // namespace vinerow
