#pragma once
/// Sets of tube-based robust MPC, computed once: for x+ = A x + B u + E d with every gust
/// |d_i| <= gust_i and the feedback u = v + K (x - z) about a nominal state z+ = A z + B v,
///   e = x - z stays in S = W + A_K W + A_K^2 W + ...,  A_K = A + B K, W = {E d},
/// so that x and u keep their limits if z and v keep limits tightened by S.
///
/// S is known by its exact support (series_support.h; W is a zonotope, a box around it would lose
/// the correlation of the gusts' effects). The online problem needs x in z + R for an R of finitely
/// many rows, see TubeShape. The tightening is by R: |z_i| <= limit_i - h_R(e_i), |v_j| <= limit_j
/// - h_R(K_j), and the last nominal state ends in the maximal invariant set of z+ = A_K z under
/// these.
///
/// Sources: Mammarella et al., "Cooperation of unmanned systems for agricultural applications: A
/// case study in a vineyard", Biosystems Engineering 223, 2022, eq. 8-20, corrected as described in
/// docs/papers/trmpc.md; Mayne, Seron, Rakovic, "Robust model predictive control of constrained
/// linear systems with bounded disturbances", Automatica 41, 2005. For the set-up of controllers,
/// not for their steps. ConfigError if sizes do not fit or a number is not finite.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "controllers/parts/solvers/polytope.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

struct TubeModel {
  Eigen::MatrixXd A;                     ///< n x n
  Eigen::MatrixXd B;                     ///< n x m
  Eigen::MatrixXd E;                     ///< n x g
  Eigen::MatrixXd K;                     ///< m x n, u = K x with A + B K Schur stable
  Eigen::VectorXd gust;                  ///< g, >= 0: largest |d_i|
  Eigen::VectorXd state_limit;           ///< n, > 0: largest |x_i|
  Eigen::VectorXd input_limit;           ///< m, > 0: largest |u_j|
  std::vector<std::string> state_names;  ///< n, for messages, "altitude"; empty: "state 4"
  std::vector<std::string> input_names;  ///< m
};

/// Half widths of S: the exact support along each state and each row of K.
struct TubeReach {
  Eigen::VectorXd state;  ///< n
  Eigen::VectorXd input;  ///< m
};

/// Strength of gusts that the limits allow.
struct GustMargin {
  TubeReach reach;
  /// Factor by which all gusts may grow before the tightened limits close; infinite without gusts.
  /// Below it the tightened sets contain the origin in their interior, and with it a terminal set:
  /// the problem is recursively feasible.
  double factor = 0.0;
  std::string binding;  ///< the limit that closes first, "aileron"
};

/// @returns a failure if A + B K is not Schur stable
Result<GustMargin> calc_gust_margin(const TubeModel& model);

/// Approximation R of "x in z + S" in the online problem.
enum class TubeShape {
  /// |x - z| and |K (x - z)| within the half widths of S: few rows, but no invariant set, so
  /// recursive feasibility holds in practice only.
  kBox,
  /// The largest invariant set under the gusts inside that box widened by `margin`: many rows, and
  /// the next problem is feasible if this one is.
  kInvariant,
};

struct TubeSets {
  Eigen::MatrixXd A_K;
  GustMargin gust_margin;
  double margin = 0.0;  ///< R's half widths are (1 + margin) of those of S; 0 for kBox
  /// R = {e : |F e| <= g}; rows scaled so that g is 1. No rows without gusts: R = {0}.
  Eigen::MatrixXd tube_rows;
  Eigen::VectorXd state_limit;  ///< n, tightened by R, > 0
  Eigen::VectorXd input_limit;  ///< m
  /// {z : |F z| <= 1}: a state in it keeps all tightened limits forever under v = K z.
  Eigen::MatrixXd terminal_rows;
  int terminal_steps = 0;  ///< t* of Gilbert and Tan
};

/// The margin of kInvariant is 1 %, or half of what the gusts leave if that is less.
/// @returns a failure "the tube is empty: gusts alone take 1.40 times the limit of aileron; at most
/// 0.71 of them are feasible", or that of calc_gust_margin(), or if a set does not converge in 500
/// steps
Result<TubeSets> make_tube_sets(const TubeModel& model, TubeShape shape = TubeShape::kInvariant);

}  // namespace vinerow::controllers
