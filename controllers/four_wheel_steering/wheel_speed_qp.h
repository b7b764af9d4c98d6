#pragma once
/// Wheel speeds that are consistent with the wheel angles: the velocity QP of paper A, eq. 30-33.
///
/// Variables v are the rim speeds (front left, front right, rear left, rear right), m/s:
///
///   minimise    (alpha v - beta)^2 + rho |v - v_rb|^2
///   subject to  -eps <= A v <= eps, |v_i| <= rim_max, and optionally near the last speeds
///
/// A (eq. 33): difference of the velocities along the body of front and rear wheel of a side, and
/// of the velocities across it of left and right wheel of an axle. alpha v = beta demands the
/// wanted speed: the mean over the wheels of v_i / reach_i is the forward speed. That is eq. 31 for
/// parallel axles and otherwise eq. 32 times the ICR's distance (alpha_i = 1 / r_i = k / reach_i,
/// beta = 4 Omega), so one formula covers both. The speed is reduced beforehand so that the rolling
/// speeds v_rb keep the rim limit: then v_rb costs nothing and is the optimum, unless the limit of
/// wheel acceleration is active.
///
/// As printed the cost has rank 1 and the rows are one-sided, A v <= eps: for straight driving at
/// 1 m/s [.4 .4 1.6 1.6] costs nothing and is allowed. `WheelSpeedForm::kPrinted` solves that
/// problem, with a negligible weight on |v|^2 that makes the minimiser unique.

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
  /// @param speed_mps  of B's origin, signed; within limit_speed() except in tests
  QpStatus solve(const Rolling& rolling, double speed_mps);

  /// Of the last solve(), m/s. Valid only if it was kSolved.
  Eigen::Vector4d rim_mps() const { return solver_.x(); }
  int iterations() const { return solver_.iterations(); }

  /// The last speeds for the next solve() (for the limit of change).
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
