#pragma once
/// Online part of tube-based robust MPC: optimal nominal state z_0 and inputs v_0 .. v_{N-1},
///   minimise   sum_{i<N} |z_i|_Q^2 + |v_i|_R^2 + |z_N|_P^2,   z_{i+1} = A z_i + B v_i
///   subject to x in z_0 + R,  z_i within the tightened state limits (i = 0..N-1),
///              v_i within the tightened input limits,  z_N in the terminal set,
/// then u = v_0 + K (x - z_0). Sets: tube_sets.h; form of the QP: tube_form.h.
///
/// Limits of inputs and x in z_0 + R are hard, those of z_i and z_N soft with a large quadratic
/// weight: z_0 = x is always feasible, and u keeps its limits for any x. If x is in R, z_0 = 0 and
/// v = K z is the optimum, so u = K x; that needs no QP.
/// No heap after construction. The same sequence of calls gives the same bits.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "controllers/parts/solvers/qp.h"
#include "controllers/parts/solvers/tube_form.h"
#include "controllers/parts/solvers/tube_sets.h"

namespace vinerow::controllers {

/// Start of the nominal state, and the resulting law.
enum class TubeLaw {
  kTube,        ///< z_0 free: Mayne, Seron, Rakovic 2005
  kFixedStart,  ///< z_0 = x: the feedback is inactive, v has all authority
  /// z_0 by its own model from the step before (in the spirit of Chisci, Rossiter, Zappa,
  /// Automatica 37, 2001), free if x is not in z_0 + R
  kPropagated,
  kPrinted,  ///< paper A as printed: z_0 = x and u = v_0 + K x, which counts K x twice
};

struct TubeMpcSettings {
  TubeLaw law = TubeLaw::kTube;
  /// 1/2 weight s^2 of a violation by s times the (tightened) limit; infinite: hard, and then the
  /// problem may have no solution.
  double soft_weight = 1e9;
  QpSettings qp = {.max_iterations = 3000};
};

class TubeMpc {
 public:
  /// @throws ConfigError "<who>: ..." if sizes do not fit or the cost is not positive definite
  TubeMpc(const TubeModel& model, const TubeSets& sets, const TubeCost& cost,
          const TubeMpcSettings& settings, const std::string& who);

  int states() const { return static_cast<int>(model_.A.rows()); }
  int inputs() const { return static_cast<int>(model_.B.cols()); }
  int horizon() const { return horizon_; }

  /// @param x  n, the current state. After any status but kSolved u() is K x within the input
  /// limits, zero if x is not finite.
  QpStatus solve(const Eigen::Ref<const Eigen::VectorXd>& x);
  /// Forgets all earlier calls.
  void cold_start();

  const Eigen::VectorXd& u() const { return u_; }    ///< m
  const Eigen::VectorXd& z0() const { return z0_; }  ///< n
  const Eigen::VectorXd& v0() const { return v0_; }  ///< m
  /// c_i of v_i = K z_i + c_i, one after the other, Nm entries.
  Eigen::VectorXd corrections() const { return y_.tail(y_.size() - states()); }
  double cost() const { return cost_; }           ///< with the cost of soft rows
  int iterations() const { return iterations_; }  ///< changes of the QP's active set
  int active_rows() const { return active_rows_; }
  /// Share of the tube that x - z_0 uses: 1 at its edge; 0 without a tube.
  double tube_share() const { return tube_share_; }
  /// Largest violation of a soft limit in the prediction, as a share of the limit.
  double soft_violation() const { return soft_violation_; }
  /// The limit with that violation. @pre soft_violation() > 0
  const TubeRow& worst_row() const { return worst_row_; }

 private:
  bool choose_start(const Eigen::Ref<const Eigen::VectorXd>& x);
  bool unconstrained_is_optimal(bool is_fixed);
  QpStatus optimise(bool is_fixed);
  void look_for_violation(int row);
  void finish(const Eigen::Ref<const Eigen::VectorXd>& x);
  void fall_back(const Eigen::Ref<const Eigen::VectorXd>& x);

  TubeModel model_;
  TubeSets sets_;
  TubeMpcSettings settings_;
  int horizon_;
  TubeForm form_;
  int tube_rows_;  // of the QP
  QpSolver qp_;
  Eigen::VectorXd f_, lower_, upper_, row_lower_, row_upper_;

  Eigen::VectorXd y_, u_, z0_, v0_, start_, error_;
  Eigen::VectorXd tube_values_, terminal_values_;
  Eigen::VectorXd next_z_;  // z_1 of the step before
  bool has_next_ = false;
  double cost_ = 0.0, tube_share_ = 0.0, soft_violation_ = 0.0;
  int iterations_ = 0, active_rows_ = 0;
  TubeRow worst_row_;
};

}  // namespace vinerow::controllers
