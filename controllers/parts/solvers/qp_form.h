#pragma once
/// Quadratic programme rewritten as the search for the point nearest to -v.
///
/// With H^-1 = K K' (K lower triangular), x = K y and v = K' f,
///   1/2 x'Hx + f'x = 1/2 |y + v|^2 - 1/2 |v|^2,
/// and every bound and row becomes lower_i <= g_i y <= upper_i with G = [K; A K]. Bounds cost no
/// more than x = K y itself, and a row of A that ends in zeros (a state constraint of a condensed
/// MPC) gives a row of G that ends in the same zeros, which no product visits.
///
/// Source of the transformation: Arnstrom, Bemporad, Axehill, "A dual active-set solver for
/// embedded quadratic programming using recursive LDL' updates", IEEE TAC 67(8), 2022;
/// there K is upper triangular and the zeros are lost.

#include <Eigen/Core>
#include <vector>

namespace vinerow::controllers::qp {

using Vector = Eigen::Map<Eigen::VectorXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

class Form {
 public:
  /// @param tolerance  largest violation of a constraint, per length of its row
  Form(int variables, int rows, double tolerance);

  int variables() const { return n_; }
  int constraints() const { return n_ + m_; }

  /// @returns false if H (lower triangle) is not positive definite to working precision
  bool set_hessian(const Eigen::Ref<const Eigen::MatrixXd>& H);
  /// @returns false if a number is not finite
  bool set_rows(const Eigen::Ref<const Eigen::MatrixXd>& A);
  /// Updates A K. @returns true if G has changed since the last call
  bool refresh();

  /// Row i of G; only its first end(i) numbers can be nonzero.
  const double* row(int i) const { return G_.data() + static_cast<Eigen::Index>(i) * stride_; }
  int end(int i) const { return end_[static_cast<std::size_t>(i)]; }
  double row_squared(int i) const { return squared_[i]; }
  /// 1 / |g_i|, and the tolerance of constraint i times that. A zero row counts as of length 1.
  const Eigen::ArrayXd& inverse_length() const { return inverse_length_; }
  const Eigen::ArrayXd& scaled_tolerance() const { return scaled_tolerance_; }

  /// v = K' f
  void to_gradient(const Eigen::Ref<const Eigen::VectorXd>& f, Eigen::VectorXd& v) const;
  double value_at(int i, const Eigen::VectorXd& y) const;  ///< g_i y
  /// values = G y; the first n of them are x
  void values_at(const Eigen::VectorXd& y, Eigen::VectorXd& values) const;

 private:
  /// Rows [first, first + count) of G, multiplied in one piece of `columns` columns.
  struct Block {
    int first, count, columns;
  };

  void describe_row(int i, double length);
  void add_block(int first, int count, int columns);

  int n_, m_;
  Eigen::Index stride_;
  double tolerance_;
  bool hessian_changed_ = false, rows_changed_ = false;
  Eigen::VectorXd G_;        // (n + m) x stride, row by row
  Eigen::VectorXd A_;        // m x stride, row by row
  Eigen::VectorXd factor_;   // n x stride: Cholesky factor of H with rows and columns reversed
  Eigen::VectorXd inverse_;  // n x stride: its inverse
  std::vector<int> end_;
  std::vector<Block> blocks_;
  Eigen::ArrayXd squared_, inverse_length_, scaled_tolerance_;
};

}  // namespace vinerow::controllers::qp
