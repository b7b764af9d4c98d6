#pragma once
/// Where a linear model can rest with its outputs at wanted values under a constant disturbance:
///
///   A x_s + B u_s + w = x_s,   C x_s = r
///
/// The state of rest comes first: where no state of rest has C x_s = r, it is the one with the
/// smallest |C x_s - r|; where several do, it is the one with the smallest |x_s|^2 + |u_s|^2.
/// Source: Muske, Badgwell, "Disturbance modeling for offset-free linear model predictive control",
/// J. Process Control 12, 2002, section 2; limits are left to the controller.

#include <Eigen/Core>
#include <string>

namespace vinerow {

class SteadyStateTarget {
 public:
  /// @param A  n x n  @param B  n x m  @param C  p x n
  /// @throws ConfigError naming the matrix and its shape
  SteadyStateTarget(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& C,
                    const std::string& who);

  /// @param disturbance  w = E d, n  @param wanted  r, p
  /// A deviation from a reference that the model itself follows takes r = 0: targets add up. No
  /// heap.
  void solve(const Eigen::Ref<const Eigen::VectorXd>& disturbance,
             const Eigen::Ref<const Eigen::VectorXd>& wanted);
  const Eigen::VectorXd& x() const { return x_; }  ///< n
  const Eigen::VectorXd& u() const { return u_; }  ///< m
  /// True if every disturbance and every r has a target without any error.
  bool always_exact() const { return always_exact_; }

 private:
  Eigen::MatrixXd x_of_w_, x_of_r_, u_of_w_, u_of_r_;
  Eigen::VectorXd x_, u_;
  bool always_exact_ = false;
};

}  // namespace vinerow
