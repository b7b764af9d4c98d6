#pragma once
/// Rows F x <= g of a linear programme, scaled so that pivots and tolerances are comparable: the
/// variables by powers of two (geometric means of the columns), then each row to length one.

#include <Eigen/Core>

namespace vinerow::controllers::lp {

class Rows {
 public:
  Rows(int variables, int max_rows);

  /// @param F  rows x n @param g  rows
  void set(const Eigen::Ref<const Eigen::MatrixXd>& F, const Eigen::Ref<const Eigen::VectorXd>& g);
  void set_limit(int row, double g);

  int count() const { return count_; }
  bool valid() const;  ///< no NaN, F finite, no limit of minus infinity
  /// A row of zeros with a limit below zero, or -1.
  int contradiction() const;

  /// Rows of length one over the scaled variables z, x = scale z.
  /// product.head(count()) = F z. No heap.
  void multiply(const Eigen::VectorXd& z, Eigen::VectorXd& product) const;
  auto row(int i) const { return F_.row(i).transpose(); }
  const Eigen::VectorXd& g() const { return g_; }
  /// False for rows of zeros and infinite limits, which constrain nothing.
  bool in_force(int i) const { return length_[i] > 0.0 && g_[i] < kNoLimit; }
  const Eigen::VectorXd& scale() const { return scale_; }
  /// Length of row i before scaling to one.
  double length(int i) const { return length_[i]; }

 private:
  static constexpr double kNoLimit = 1.7976931348623157e308;
  void choose_scale();

  int count_ = 0;
  bool matrix_finite_ = true;
  Eigen::MatrixXd F_;        // max_rows x n
  Eigen::VectorXd g_;        // max_rows
  Eigen::VectorXd length_;   // max_rows
  Eigen::VectorXd scale_;    // n
  Eigen::VectorXd largest_;  // max_rows, largest entry of a row while scaling
};

}  // namespace vinerow::controllers::lp
