#pragma once
/// LU factors of the small square basis of a simplex method, without heap after construction.

#include <Eigen/Core>
#include <vector>

namespace vinerow::controllers::lp {

class Basis {
 public:
  explicit Basis(int n);

  /// Column k, to be filled before factor().
  Eigen::Ref<Eigen::VectorXd> column(int k) { return columns_.col(k); }
  /// Gaussian elimination with partial pivoting. @returns false if a pivot is zero or NaN
  bool factor();
  /// y of B y = c, refined once. @param c  n @param y  n, not c itself
  void solve(const Eigen::VectorXd& c, Eigen::VectorXd& y);
  /// x of B' x = g, refined once. @param g  n @param x  n, not g itself
  void solve_transposed(const Eigen::VectorXd& g, Eigen::VectorXd& x);

 private:
  void apply_inverse(Eigen::VectorXd& v);
  void apply_inverse_transposed(Eigen::VectorXd& v);

  int n_;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd factors_;  // L below the diagonal (ones on it), U from it on
  std::vector<int> order_;   // row order_[k] of B became row k
  Eigen::VectorXd residual_, moved_;
};

}  // namespace vinerow::controllers::lp
