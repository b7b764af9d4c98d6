#pragma once
/// Estimates a constant disturbance of a linear model, so that a controller that counts on it
/// leaves no steady error (offset-free control):
///
///   x+ = A x + B u + E d,   d+ = d,   y = C x
///
/// with the steady-state Kalman filter of the augmented state (x, d). What is estimated as d takes
/// in every error of the model as well that does not change.
/// Sources: Muske, Badgwell, "Disturbance modeling for offset-free linear model predictive
/// control", J. Process Control 12, 2002; Pannocchia, Rawlings, "Disturbance models for offset-free
/// model-predictive control", AIChE J. 49(2), 2003. No steady error needs as many disturbances as
/// outputs y (Pannocchia and Rawlings, prop. 1).

#include <Eigen/Core>
#include <memory>
#include <string>

namespace vinerow {

struct DisturbanceModel {
  Eigen::MatrixXd A;  ///< n x n
  Eigen::MatrixXd B;  ///< n x m
  Eigen::MatrixXd E;  ///< n x n_d
  Eigen::MatrixXd C;  ///< p x n; identity where the whole state is measured
  /// Standard deviations per step: what the model misses of x (n), how fast d wanders (n_d, > 0),
  /// noise of y (p, > 0). Only their ratios decide; the larger that of d, the faster and the
  /// noisier its estimate.
  Eigen::VectorXd state_noise, disturbance_noise, measurement_noise;
};

class DisturbanceObserver {
 public:
  /// @throws ConfigError naming the matrix and its shape, or if d cannot be told from x: "<who>:
  /// the rank of [A - I, E; C, 0] is 5, must be 6: ..."
  DisturbanceObserver(const DisturbanceModel& model, const std::string& who);
  ~DisturbanceObserver();
  DisturbanceObserver(DisturbanceObserver&&) noexcept;
  DisturbanceObserver& operator=(DisturbanceObserver&&) noexcept;

  /// @param x  n  @param d  n_d
  void reset(const Eigen::Ref<const Eigen::VectorXd>& x,
             const Eigen::Ref<const Eigen::VectorXd>& d);
  /// One sample. @param measured  y now, p  @param input_before  m, what has acted since the last
  /// step(): after saturation, else the observer takes the lost input for a disturbance
  /// @returns false, and only predicts, if a number of `measured` is not finite; false and leaves
  /// all as it was if one of `input_before` is not. No heap.
  bool step(const Eigen::Ref<const Eigen::VectorXd>& measured,
            const Eigen::Ref<const Eigen::VectorXd>& input_before);

  const Eigen::VectorXd& x() const;            ///< n, estimate at the time of the last step()
  const Eigen::VectorXd& d() const;            ///< n_d
  const Eigen::VectorXd& disturbance() const;  ///< E d, n: as LinearMpc::solve() takes it
  const Eigen::MatrixXd& gain() const;         ///< (n + n_d) x p, of y - C x predicted
  /// Largest eigenvalue of the estimation error from step to step: it falls like radius^k.
  double error_radius() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow
