#include "controllers/parts/solvers/series_support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/solvers/riccati.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr double kContraction = 0.5;
constexpr int kMaxBlock = 1'000'000;
constexpr double kTail = 1e-12;  // of the support: small against the 1e-9 of the programmes

/// r_j: joint reach of W and its first n - 1 images along axis j. It is more than that of W alone,
/// above zero for all states that the disturbance reaches, and in the units of the states.
Result<Eigen::VectorXd> calc_reach(const Eigen::MatrixXd& A, const Support& W) {
  const Eigen::Index n = A.rows();
  Eigen::VectorXd reach = Eigen::VectorXd::Zero(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    Eigen::VectorXd c = Eigen::VectorXd::Unit(n, j);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double above = W(c), below = W(-c);
      if (!(above >= -below)) return Failure{"the disturbance set is empty"};
      if (std::isinf(above) || std::isinf(below)) {
        return Failure{fmt::format("the disturbance set is unbounded along state {}", j)};
      }
      reach[j] += std::max(std::abs(above), std::abs(below));
      c = A.transpose() * c;
    }
  }
  const double max_reach = reach.maxCoeff();
  return Eigen::VectorXd(reach.cwiseMax(max_reach > 0.0 ? 1e-3 * max_reach : 1.0));
}

}  // namespace

Result<SeriesSupport> SeriesSupport::make(const Eigen::MatrixXd& A, const Support& W) {
  if (A.rows() < 1 || A.rows() != A.cols()) {
    throw ConfigError(fmt::format("A is {} x {}, must be square", A.rows(), A.cols()));
  }
  if (!A.allFinite()) throw ConfigError("A contains a number that is not finite");
  const double radius = spectral_radius(A);
  if (!(radius < 1.0)) {
    return Failure{
        fmt::format("A is not Schur stable: its spectral radius is {:.6g}, must be < 1", radius)};
  }
  Result<Eigen::VectorXd> reach = calc_reach(A, W);
  if (!reach) return Failure{reach.reason()};
  SeriesSupport series;
  series.A_ = A;
  series.W_ = W;
  series.reach_ = *reach;
  Eigen::MatrixXd power = A;
  for (series.block_ = 1; series.block_ <= kMaxBlock; ++series.block_) {
    const Eigen::VectorXd image = power.cwiseAbs() * series.reach_;
    series.contraction_ = image.cwiseQuotient(series.reach_).maxCoeff();
    if (series.contraction_ <= kContraction) return series;
    power = power * A;
  }
  return Failure{fmt::format(
      "{} steps of A do not halve every state: its spectral radius is {:.9g}", kMaxBlock, radius)};
}

SeriesSupport::Bound SeriesSupport::bound(const Eigen::VectorXd& c) const {
  if (c.size() != A_.rows()) {
    throw ConfigError(fmt::format("a set in {} dimensions does not match a direction in {}",
                                  A_.rows(), c.size()));
  }
  const double first = c.cwiseAbs().dot(reach_);
  Eigen::VectorXd moved = c, next(c.size());
  Bound bound;
  double sum = 0.0, tail = first;
  while (tail > kTail * std::max(std::abs(sum), first)) {
    double block = 0.0;
    for (int i = 0; i < block_; ++i, ++bound.terms) {
      sum += W_(moved);
      block += moved.cwiseAbs().dot(reach_);
      next.noalias() = A_.transpose() * moved;
      moved.swap(next);
    }
    tail = block * contraction_ / (1.0 - contraction_);
  }
  // Terms may be negative if W does not contain the origin, so the tail counts both ways.
  bound.value = sum + tail;
  bound.excess = 2.0 * tail;
  return bound;
}

}  // namespace vinerow::controllers
