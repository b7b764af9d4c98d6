#pragma once
/// Wheel speeds that agree with the wheel angles: the velocity QP of paper A, eq. 30-33.
///
/// Variables v are the rim speeds (front left, front right, rear left, rear right), m/s:
///
///   minimise    (alpha v - beta)^2 + rho |v - v_rb|^2
///   subject to  -eps <= A v <= eps, |v_i| <= rim_max, and near the last speeds if asked
///
/// A (eq. 33): velocity along the body of front and rear wheel of a side, velocity across of left
/// and right wheel of an axle. alpha v = beta asks for the wanted speed: the mean over the wheels
/// of v_i / reach_i is the forward speed. That is eq. 31 for parallel axles and eq. 32 times the
/// ICR's distance elsewhere (alpha_i = 1 / r_i = k / reach_i, beta = 4 Omega), so one formula
/// without a switch. The speed is cut beforehand so that the rolling speeds v_rb keep the rim
/// limit: then v_rb costs nothing and is the optimum, unless the limit of wheel acceleration binds.
///
/// As printed the cost has rank 1 and the rows are one-sided, A v <= eps: for straight driving at 1
/// m/s [.4 .4 1.6 1.6] costs nothing and is allowed. `WheelSpeedForm::kPrinted` solves that, with a
/// weight on |v|^2 too small to matter, only because some minimiser must be named.

#include <Eigen/Core>

#include "controllers/four_wheel_steering/axle_geometry.h"
#include "controllers/parts/solvers/qp.h"

namespace vinerow::controllers {

enum class WheelSpeedForm { kTwoSided, kPrinted };

struct WheelSpeedParams {
  WheelSpeedForm form = WheelSpeedForm::kTwoSided;
  double slip_mps = 5e-3;           ///< eps; paper A: 1e-3 .. 1e-2
  double rolling_weight = 1e-3;     ///< rho
  double rim_max_mps = 1.6;         ///< per wheel
  double rim_change_max_mps = 0.0;  ///< per cycle and wheel; 0 = no limit
};

class WheelSpeedQp {
 public:
  explicit WheelSpeedQp(const WheelSpeedParams& params);

  /// Sets the problem for these axle angles and speed, and solves it. No heap.
  /// @param speed_mps  of B's origin, signed; limit_speed() it before unless it is to be tested
  QpStatus solve(const Rolling& rolling, double speed_mps);

  /// Of the last solve(), m/s. Only meaningful if it was kSolved.
  Eigen::Vector4d rim_mps() const { return solver_.x(); }
  int iterations() const { return solver_.iterations(); }

  /// What the next solve() calls the last speeds (for the limit of change).
  void set_last(const Eigen::Vector4d& rim_mps) { last_mps_ = rim_mps; }

  /// (alpha v - beta)^2 of the problem set last.
  double cost(const Eigen::Vector4d& rim_mps) const;
  /// A v, m/s.
  Eigen::Vector4d slip_mps(const Eigen::Vector4d& rim_mps) const { return A_ * rim_mps; }

  const Eigen::Vector4d& alpha() const { return alpha_; }
  double beta() const { return beta_; }
  const Eigen::Vector4d& rolling_mps() const { return rolling_mps_; }

 private:
  void set_problem(const Rolling& rolling, double speed_mps);

  WheelSpeedParams params_;
  QpSolver solver_;
  Eigen::Vector4d last_mps_ = Eigen::Vector4d::Zero();
  Eigen::Vector4d alpha_ = Eigen::Vector4d::Ones();
  double beta_ = 0.0;
  Eigen::Vector4d rolling_mps_ = Eigen::Vector4d::Zero();
  Eigen::MatrixXd H_, A_;
  Eigen::VectorXd f_, lower_, upper_, row_lower_, row_upper_;
};

}  // namespace vinerow::controllers
