#pragma once
/// Dense strictly convex quadratic programmes, solved by a dual active-set method:
///
///   minimise    1/2 x'H x + f'x
///   subject to  lower <= x <= upper                 (bounds; infinite where there are none)
///               row_lower <= A x <= row_upper       (rows; equal values make an equality)
///
/// A row can be soft: it may be violated by s at the cost 1/2 weight s^2. All memory is taken in
/// the constructor; the set of active constraints is kept as the start of the next solve().

#include <Eigen/Core>
#include <vector>

namespace vinerow {

enum class QpStatus {
  kSolved,
  kInfeasible,      ///< no x satisfies the hard constraints
  kNotConvex,       ///< H is not positive definite
  kIterationLimit,  ///< x is the last iterate: do not use it as if it were solved
};
const char* to_string(QpStatus status);

struct QpSettings {
  double tolerance = 1e-9;  ///< largest violation of a constraint, scaled by the length of its row
  int max_iterations = 1000;
};

class QpSolver {
 public:
  /// @param variables  n >= 1  @param rows  m >= 0
  QpSolver(int variables, int rows, const QpSettings& settings = {});
  ~QpSolver();
  QpSolver(QpSolver&&) noexcept;
  QpSolver& operator=(QpSolver&&) noexcept;

  int variables() const;
  int rows() const;

  /// @param H  n x n, symmetric (the lower triangle is read). @returns false if it is not positive
  /// definite; solve() then says kNotConvex
  bool set_hessian(const Eigen::Ref<const Eigen::MatrixXd>& H);
  /// @param A  m x n
  void set_rows(const Eigen::Ref<const Eigen::MatrixXd>& A);
  /// @param weight  > 0; infinity makes the row hard again
  void soften_row(int row, double weight);

  /// @param f,lower,upper  n  @param row_lower,row_upper  m; lower <= upper, else kInfeasible
  /// No heap.
  QpStatus solve(const Eigen::Ref<const Eigen::VectorXd>& f,
                 const Eigen::Ref<const Eigen::VectorXd>& lower,
                 const Eigen::Ref<const Eigen::VectorXd>& upper,
                 const Eigen::Ref<const Eigen::VectorXd>& row_lower,
                 const Eigen::Ref<const Eigen::VectorXd>& row_upper);
  /// Forgets the active set: the next solve() does not depend on earlier ones.
  void cold_start();

  /// Of the last solve().
  const Eigen::VectorXd& x() const;
  /// Multipliers of bounds (n) and rows (m): positive at an upper limit, negative at a lower one;
  /// H x + f + lambda_bounds + A' lambda_rows = 0.
  const Eigen::VectorXd& multipliers() const;
  double cost() const;
  int iterations() const;
  /// Indices of active constraints: bounds 0..n-1, rows n..n+m-1.
  const std::vector<int>& active_set() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace vinerow
