#pragma once
/// An outer approximation of the smallest set that x+ = A x + w, w in W, does not leave, which is
/// itself invariant: (1 - alpha)^-1 (W + A W + ... + A^(s-1) W), where A^s W is a subset of alpha
/// W. Its support is at most 1 / (1 - alpha) times the exact one of SeriesSupport. Source: Rakovic,
/// Kerrigan, Kouramas, Mayne, "Invariant approximations of the minimal robust positively invariant
/// set", IEEE TAC 50(3), 2005, algorithm 1.

#include <Eigen/Core>
#include <limits>

#include "controllers/parts/polytope.h"
#include "engine/core/result.h"

namespace vinerow {

class OuterMinimalSet {
 public:
  struct Settings {
    double most_alpha = 0.02;
    /// Largest distance from the minimal set along any state, in the states' units.
    double accuracy = std::numeric_limits<double>::infinity();
    int max_steps = 10'000;
  };

  /// With the least s for both.
  /// @param W  bounded, the origin inside. For one without an inside there is SeriesSupport.
  /// @returns a failure if A is not Schur stable, the origin is not inside W, W has no end, or the
  /// steps do not suffice
  static Result<OuterMinimalSet> make(const Eigen::MatrixXd& A, const Polytope& W,
                                      const Settings& settings);

  double alpha() const { return alpha_; }
  int steps() const { return steps_; }
  /// Upper bound of the distance from the minimal set along any state.
  double accuracy() const { return accuracy_; }

  double support(const Eigen::VectorXd& c) const;
  double operator()(const Eigen::VectorXd& c) const { return support(c); }

 private:
  OuterMinimalSet(Eigen::MatrixXd A, Polytope W);

  Eigen::MatrixXd A_;
  Polytope W_;
  double alpha_ = 1.0;
  int steps_ = 0;
  double accuracy_ = 0.0;
};

}  // namespace vinerow
