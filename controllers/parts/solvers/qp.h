#pragma once
/// Solver for dense strictly convex quadratic programmes, by a dual active-set method:
///
///   minimise    1/2 x'H x + f'x
///   subject to  lower <= x <= upper                 (bounds; infinite for no limit)
///               row_lower <= A x <= row_upper       (rows; equal values make an equality)
///
/// A row can be soft: a violation by s is allowed at the cost 1/2 weight s^2. The constructor takes
/// all memory; the set of active constraints is kept as the start of the next solve().
///
/// Method: Arnstrom, Bemporad, Axehill, "A dual active-set solver for embedded quadratic
/// programming using recursive LDL' updates", IEEE TAC 67(8), 2022.
/// The cost of set_hessian() and set_rows(), O(n^3 + m n^2), arises once and only when they are
/// called. A solve() whose active set of k constraints still holds costs about
/// n^2 + (n + m + 2k) n + k^2 multiplications, half of that if the rows of A end in zeros.
/// The same sequence of calls since the constructor or cold_start() gives the same bits. Two hard
/// rows that meet at less than 1e-8 rad in the metric of H count as one.

#include <Eigen/Core>
#include <vector>

namespace vinerow::controllers {

enum class QpStatus {
  kSolved,
  kInfeasible,      ///< no x satisfies the hard constraints
  kNotConvex,       ///< H is not positive definite (or contains a NaN, or was never set)
  kIterationLimit,  ///< stopped at QpSettings::max_iterations
  kInvalidInput,    ///< a NaN in any input, or an infinite f or A
};
const char* to_string(QpStatus status);

struct QpSettings {
  /// Largest violation of a constraint, scaled by the length of its row, in addition to the
  /// rounding of large numbers.
  double tolerance = 1e-9;
  int max_iterations = 1000;  ///< changes of the active set in one solve()
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
  /// definite; solve() then returns kNotConvex
  bool set_hessian(const Eigen::Ref<const Eigen::MatrixXd>& H);
  /// @param A  m x n
  void set_rows(const Eigen::Ref<const Eigen::MatrixXd>& A);
  /// @param row  0..m-1  @param weight  > 0; infinity makes the row hard again. Weights are capped
  /// at 1e12 / (a' H^-1 a), beyond which a soft row is numerically hard.
  void soften_row(int row, double weight);

  /// @param f,lower,upper  n  @param row_lower,row_upper  m; lower <= upper, else kInfeasible
  /// No heap, no exception. After any status but kSolved the next solve() starts cold.
  QpStatus solve(const Eigen::Ref<const Eigen::VectorXd>& f,
                 const Eigen::Ref<const Eigen::VectorXd>& lower,
                 const Eigen::Ref<const Eigen::VectorXd>& upper,
                 const Eigen::Ref<const Eigen::VectorXd>& row_lower,
                 const Eigen::Ref<const Eigen::VectorXd>& row_upper);
  /// Forgets the active set: the next solve() does not depend on earlier ones.
  void cold_start();

  /// Of the last solve(). If it did not return kSolved the results are useless: zeros, or the last
  /// iterate.
  const Eigen::VectorXd& x() const;
  /// Multipliers of bounds (n) and rows (m): positive at an upper limit, negative at a lower one;
  /// H x + f + lambda_bounds + A' lambda_rows = 0.
  const Eigen::VectorXd& multipliers() const;
  /// 1/2 x'H x + f'x, and 1/2 weight s^2 of each violated soft row.
  double cost() const;
  /// Constraints added to and removed from the active set.
  int iterations() const;
  /// Indices of active constraints: bounds 0..n-1, rows n..n+m-1.
  const std::vector<int>& active_set() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace vinerow::controllers
