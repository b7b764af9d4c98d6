#include "controllers/parts/solvers/invariant_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "controllers/parts/solvers/linear_programme.h"
#include "controllers/parts/solvers/series_support.h"
#include "controllers/parts/solvers/zonotope.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

/// Intersection of the rows so far; rows that do not cut it are not added.
class Gathered {
 public:
  explicit Gathered(const Polytope& X) : set_(X) {}

  struct Cut {
    int row = 0;
    double depth = 0.0;
  };

  /// Adds the rows of F x <= g that cut by more than the tolerance. @returns the deepest cut
  std::optional<Cut> add(const Eigen::MatrixXd& F, const Eigen::VectorXd& g, double tolerance) {
    LinearProgramme programme(set_.dimension(), set_.rows());
    programme.set_rows(set_.F(), set_.g());
    std::vector<int> cutting;
    std::optional<Cut> deepest;
    for (int i = 0; i < F.rows(); ++i) {
      const Eigen::VectorXd row = F.row(i);
      const LpStatus status = programme.maximise(row);
      if (status != LpStatus::kSolved && status != LpStatus::kUnbounded) {
        throw ConfigError(fmt::format("a linear programme of {} rows in {} variables failed: {}",
                                      programme.rows(), programme.variables(), to_string(status)));
      }
      const double depth = programme.value() - g[i];
      if (depth <= tolerance * (std::abs(g[i]) + row.norm() * programme.x().norm())) continue;
      cutting.push_back(i);
      if (!deepest || depth > deepest->depth) deepest = Cut{i, depth};
    }
    if (deepest) {
      set_ = set_.intersection(Polytope(F(cutting, Eigen::all), g(cutting)));
      // Later rows make earlier ones redundant, and these would slow the programmes down.
      if (set_.rows() > 2 * clean_rows_ + 64) {
        set_ = set_.without_redundant_rows();
        clean_rows_ = set_.rows();
      }
    }
    return deepest;
  }
  const Polytope& set() const { return set_; }

 private:
  Polytope set_;
  int clean_rows_ = 0;
};

void demand_dimensions(const Eigen::MatrixXd& A, const Polytope& X) {
  if (A.rows() == X.dimension() && A.cols() == X.dimension()) return;
  throw ConfigError(fmt::format("A is {} x {} but the constraints are in {} dimensions", A.rows(),
                                A.cols(), X.dimension()));
}

Result<InvariantSet> gather(const Eigen::MatrixXd& A, const Polytope& X, const Support& W,
                            const InvariantSettings& settings) {
  Gathered gathered(X);
  Eigen::MatrixXd F = X.F();
  Eigen::VectorXd g = X.g();
  std::optional<Gathered::Cut> cut;
  for (int step = 0; step <= settings.max_steps; ++step) {
    for (int i = 0; i < X.rows(); ++i) g[i] -= W(F.row(i));
    F = F * A;
    cut = gathered.add(F, g, settings.tolerance);
    if (!cut) return InvariantSet{gathered.set().without_redundant_rows(), step};
  }
  return Failure{fmt::format(
      "the invariant set does not converge in {} steps: row {} still cuts off {:.3g} of "
      "its limit {:.3g}",
      settings.max_steps, cut->row, cut->depth, g[cut->row])};
}

}  // namespace

Result<InvariantSet> maximal_invariant_set(const Eigen::MatrixXd& A, const Polytope& X,
                                           const InvariantSettings& settings) {
  demand_dimensions(A, X);
  for (int i = 0; i < X.rows(); ++i) {
    if (X.g()[i] > 0.0 || (X.F().row(i).isZero(0.0) && X.g()[i] == 0.0)) continue;
    return Failure{fmt::format(
        "the origin is not inside the constraints: row {} has the limit {:.6g}, must be > 0", i,
        X.g()[i])};
  }
  return maximal_robust_invariant_set(A, X, Zonotope(Eigen::MatrixXd(A.rows(), 0)), settings);
}

Result<InvariantSet> maximal_robust_invariant_set(const Eigen::MatrixXd& A, const Polytope& X,
                                                  const Support& W,
                                                  const InvariantSettings& settings) {
  demand_dimensions(A, X);
  const Result<SeriesSupport> alone = SeriesSupport::make(A, W);
  if (!alone) return Failure{alone.reason()};
  for (int i = 0; i < X.rows(); ++i) {
    const Eigen::VectorXd row = X.F().row(i);
    if (row.isZero(0.0) && X.g()[i] >= 0.0) continue;
    // For a row that the disturbance exactly fills the steps would not end.
    const double moved = (*alone)(row), limit = X.g()[i];
    if (moved < limit - settings.tolerance * std::abs(limit)) continue;
    return Failure{fmt::format(
        "the disturbance is too large: alone it brings row {} of the constraints to {:.6g}, the "
        "limit is {:.6g}",
        i, moved, limit)};
  }
  return gather(A, X, W, settings);
}

}  // namespace vinerow::controllers
