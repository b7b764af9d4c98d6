#include "controllers/parts/outer_minimal_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "controllers/parts/series_support.h"
#include "engine/core/error.h"

namespace vinerow {

OuterMinimalSet::OuterMinimalSet(Eigen::MatrixXd A, Polytope W)
    : A_(std::move(A)), W_(std::move(W)) {}

Result<OuterMinimalSet> OuterMinimalSet::make(const Eigen::MatrixXd& A, const Polytope& W,
                                              const Settings& settings) {
  if (A.rows() != W.dimension() || A.cols() != W.dimension()) {
    throw ConfigError(fmt::format("A is {} x {} but the disturbance is in {} dimensions", A.rows(),
                                  A.cols(), W.dimension()));
  }
  const Eigen::Index n = A.rows();
  for (int i = 0; i < W.rows(); ++i) {
    if (W.g()[i] > 0.0 || W.F().row(i).isZero(0.0)) continue;
    return Failure{
        fmt::format("the origin is not inside the disturbance set: its row {} has the limit "
                    "{:.6g}, must be > 0",
                    i, W.g()[i])};
  }
  // Says whether A is Schur stable and W bounded.
  const Result<SeriesSupport> series = SeriesSupport::make(A, W);
  if (!series) return Failure{series.reason()};

  OuterMinimalSet outer(A, W);
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd above = Eigen::VectorXd::Zero(n), below = Eigen::VectorXd::Zero(n);
  for (outer.steps_ = 1; outer.steps_ <= settings.max_steps; ++outer.steps_) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::VectorXd row = power.row(j);
      above[j] += W.support(row);
      below[j] += W.support(-row);
    }
    power = power * A;
    outer.alpha_ = 0.0;
    for (int i = 0; i < W.rows(); ++i) {
      const Eigen::VectorXd row = W.F().row(i);
      if (row.isZero(0.0)) continue;
      outer.alpha_ = std::max(outer.alpha_, W.support(power.transpose() * row) / W.g()[i]);
    }
    const double reach = std::max(above.maxCoeff(), below.maxCoeff());
    outer.accuracy_ = outer.alpha_ / (1.0 - outer.alpha_) * reach;
    if (outer.alpha_ < 1.0 && outer.alpha_ <= settings.most_alpha &&
        outer.accuracy_ <= settings.accuracy) {
      return outer;
    }
  }
  return Failure{fmt::format(
      "the outer minimal set is not finished in {} steps: alpha is {:.6g}, wanted {:.6g}",
      settings.max_steps, outer.alpha_, settings.most_alpha)};
}

double OuterMinimalSet::support(const Eigen::VectorXd& c) const {
  if (c.size() != A_.rows()) {
    throw ConfigError(
        fmt::format("a set in {} dimensions meets a direction in {}", A_.rows(), c.size()));
  }
  Eigen::VectorXd moved = c;
  double sum = 0.0;
  for (int i = 0; i < steps_; ++i) {
    sum += W_.support(moved);
    moved = A_.transpose() * moved;
  }
  return sum / (1.0 - alpha_);
}

}  // namespace vinerow
