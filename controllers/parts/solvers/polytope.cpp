#include "controllers/parts/solvers/polytope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "controllers/parts/solvers/linear_programme.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr double kRedundant = 1e-9;  // of a row's size: smaller cuts are ignored

void demand_dimension(const char* what, Eigen::Index got, int dimension) {
  if (got == dimension) return;
  throw ConfigError(
      fmt::format("a polytope in {} dimensions does not match {} in {}", dimension, what, got));
}

/// Linear programme over the rows of a polytope that throws on failure.
class Programme {
 public:
  Programme(const Eigen::MatrixXd& F, const Eigen::VectorXd& g)
      : lp_(static_cast<int>(F.cols()), static_cast<int>(F.rows())) {
    lp_.set_rows(F, g);
  }
  explicit Programme(const Polytope& P) : Programme(P.F(), P.g()) {}

  LpStatus maximise(const Eigen::VectorXd& c) {
    const LpStatus status = lp_.maximise(c);
    if (status == LpStatus::kIterationLimit || status == LpStatus::kInvalidInput) {
      throw ConfigError(fmt::format("a linear programme of {} rows in {} variables failed: {}",
                                    lp_.rows(), lp_.variables(), to_string(status)));
    }
    return status;
  }
  double support(const Eigen::VectorXd& c) {
    maximise(c);
    return lp_.value();
  }
  void set_limit(int row, double g) { lp_.set_limit(row, g); }
  const Eigen::VectorXd& x() const { return lp_.x(); }

 private:
  LinearProgramme lp_;
};

}  // namespace

Polytope::Polytope(Eigen::MatrixXd F, Eigen::VectorXd g) : F_(std::move(F)), g_(std::move(g)) {
  if (F_.cols() < 1) throw ConfigError("a polytope needs at least one dimension");
  if (F_.rows() != g_.size()) {
    throw ConfigError(fmt::format("a polytope has {} rows but {} limits", F_.rows(), g_.size()));
  }
  for (Eigen::Index i = 0; i < F_.rows(); ++i) {
    if (!F_.row(i).allFinite() || !std::isfinite(g_[i])) {
      throw ConfigError(
          fmt::format("row {} of a polytope contains a number that is not finite", i));
    }
  }
}

Polytope Polytope::box(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const Eigen::Index n = lower.size();
  if (upper.size() != n) {
    throw ConfigError(fmt::format("a box has {} lower and {} upper limits", n, upper.size()));
  }
  const Eigen::Index rows =
      (upper.array() < kInfinity).count() + (lower.array() > -kInfinity).count();
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(rows, n);
  Eigen::VectorXd g(rows);
  Eigen::Index row = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (std::isnan(lower[j]) || std::isnan(upper[j])) {
      throw ConfigError(fmt::format("limit {} of a box is not a number", j));
    }
    if (upper[j] < kInfinity) {
      F(row, j) = 1.0;
      g[row++] = upper[j];
    }
    if (lower[j] > -kInfinity) {
      F(row, j) = -1.0;
      g[row++] = -lower[j];
    }
  }
  return {std::move(F), std::move(g)};
}

Polytope Polytope::empty_set(int dimension) {
  return {Eigen::MatrixXd::Zero(1, dimension), Eigen::VectorXd::Constant(1, -1.0)};
}

double Polytope::support(const Eigen::VectorXd& c) const {
  demand_dimension("a direction", c.size(), dimension());
  return Programme(*this).support(c);
}

bool Polytope::contains(const Eigen::VectorXd& x, double tolerance) const {
  demand_dimension("a point", x.size(), dimension());
  for (int i = 0; i < rows(); ++i) {
    const double excess = F_.row(i).dot(x) - g_[i];
    if (!(excess <= 0.0) && !(excess <= tolerance * F_.row(i).norm())) return false;
  }
  return true;
}

bool Polytope::contains(const Polytope& other, double tolerance) const {
  demand_dimension("a polytope", other.dimension(), dimension());
  Programme programme(other);
  for (int i = 0; i < rows(); ++i) {
    const Eigen::VectorXd row = F_.row(i);
    if (!(programme.support(row) <= g_[i] + tolerance * row.norm())) return false;
  }
  return true;
}

bool Polytope::is_empty() const {
  return Programme(*this).maximise(Eigen::VectorXd::Zero(dimension())) == LpStatus::kInfeasible;
}

Polytope Polytope::intersection(const Polytope& other) const {
  demand_dimension("a polytope", other.dimension(), dimension());
  Eigen::MatrixXd F(rows() + other.rows(), dimension());
  F << F_, other.F_;
  Eigen::VectorXd g(rows() + other.rows());
  g << g_, other.g_;
  return {std::move(F), std::move(g)};
}

Polytope Polytope::linear_preimage(const Eigen::MatrixXd& A) const {
  demand_dimension("the image of a matrix", A.rows(), dimension());
  return {F_ * A, g_};
}

Polytope Polytope::scaled(double factor) const {
  if (!(factor > 0.0) || !std::isfinite(factor)) {
    throw ConfigError(fmt::format("a polytope is scaled by {}, must be > 0", factor));
  }
  return {F_, factor * g_};
}

Polytope Polytope::without_redundant_rows() const {
  if (is_empty()) return empty_set(dimension());
  Programme programme(*this);
  std::vector<int> kept;
  for (int i = 0; i < rows(); ++i) {
    const Eigen::VectorXd row = F_.row(i);
    const double length = row.norm();
    bool redundant = length == 0.0;
    if (!redundant) {
      // Moved outwards, not removed, so that the programme stays bounded along this row.
      programme.set_limit(i, g_[i] + std::max(std::abs(g_[i]), length));
      const double reached = programme.support(row);
      const double size = std::abs(g_[i]) + length * programme.x().norm();
      redundant = reached <= g_[i] + kRedundant * size;
    }
    programme.set_limit(i, redundant ? kInfinity : g_[i]);
    if (!redundant) kept.push_back(i);
  }
  return {F_(kept, Eigen::all), g_(kept)};
}

}  // namespace vinerow::controllers
