#pragma once
/// Solver for small dense linear programmes over free variables:
///
///   maximise  c'x   subject to  F x <= g        (x: n, up to about 16; F: up to some 2000 rows)
///
/// Method: the simplex method on the dual (minimise g'y, F'y = c, y >= 0), whose basis is n x n
/// whatever the number of rows. A basis is a vertex of n rows, the most violated row enters, the
/// ratio test keeps y >= 0. Phase 1 starts from artificial columns. The basis is refactored at each
/// pivot, so that rounding does not accumulate. Ties are broken by the largest pivot; after a run
/// of pivots without progress Bland's rule takes over until there is progress. Sources: Lemke, "The
/// dual method of solving the linear programming problem", Naval Res. Logist. Quart. 1, 1954;
/// Bland, "New finite pivoting rules for the simplex method", Math. Oper. Res. 2(2), 1977.
///
/// The constructor takes all memory. Each maximise() starts from scratch: its bits depend on rows
/// and c alone. A pivot costs about 2 n (m + n^2) multiplications, a programme n to some 5 n
/// pivots.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/solvers/lp_basis.h"
#include "controllers/parts/solvers/lp_rows.h"

namespace vinerow::controllers {

enum class LpStatus {
  kSolved,
  kInfeasible,      ///< no x satisfies all rows
  kUnbounded,       ///< rows can be satisfied, c'x grows without bound
  kIterationLimit,  ///< stopped at LpSettings::max_iterations, or the basis became singular
  kInvalidInput,    ///< a NaN anywhere, an infinite F or c, or a limit of minus infinity
};
const char* to_string(LpStatus status);

struct LpSettings {
  /// Relative to the size of x and of the limit, over rows of length one: rows that contradict each
  /// other by less than this still count as feasible. At an optimum rows are satisfied a hundred
  /// times more accurately.
  double tolerance = 1e-9;
  int max_iterations = 20000;  ///< pivots of one maximise()
};

class LinearProgramme {
 public:
  /// @param variables  n >= 1 @param max_rows  >= 0
  LinearProgramme(int variables, int max_rows, const LpSettings& settings = {});

  int variables() const { return n_; }
  int rows() const { return rows_.count(); }

  /// @param F  m x n, m <= max_rows @param g  m; +infinity disables the row
  void set_rows(const Eigen::Ref<const Eigen::MatrixXd>& F,
                const Eigen::Ref<const Eigen::VectorXd>& g);
  /// Replaces one limit; F stays.
  void set_limit(int row, double g);

  /// @param c  n; zero requests any point of the set. No heap, no exception.
  LpStatus maximise(const Eigen::Ref<const Eigen::VectorXd>& c);

  /// Of the last maximise(). kSolved: the optimum (a vertex, if the set has one). kUnbounded: a
  /// direction r with F r <= 0, c'r > 0. Otherwise zeros.
  const Eigen::VectorXd& x() const { return x_; }
  /// c'x if kSolved, +infinity if kUnbounded, -infinity if kInfeasible, else NaN.
  double value() const { return value_; }
  /// One per row, >= 0. kSolved: F'y = c, g'y = c'x. kInfeasible: F'y = 0 and g'y < 0, a proof of
  /// infeasibility. Otherwise zeros.
  const Eigen::VectorXd& multipliers() const { return multipliers_; }
  int iterations() const { return iterations_; }

 private:
  enum class Outcome { kOptimum, kNoDual, kNoPrimal, kStopped };
  static constexpr int kNone = -1;

  Outcome run();
  Outcome phase_one();
  bool drive_out_artificials();
  Outcome phase_two();
  LpStatus maximise_nothing();
  LpStatus finish(LpStatus status);
  bool refactor();
  bool bland() const;
  int entering_row(double allowed, double allowed_of_limit) const;
  bool enter(int row, bool artificials_may_leave);
  int leaving_place(bool artificials_may_leave) const;
  void replace(int place, int row);
  bool artificial(int place) const { return basis_[static_cast<std::size_t>(place)] < 0; }

  int n_;
  LpSettings settings_;
  lp::Rows rows_;
  lp::Basis factors_;
  std::vector<int> basis_;      // rows; -1 - j for the artificial column of variable j
  std::vector<char> excluded_;  // of rows: in the basis, not in force, or put aside
  int stalled_ = 0;             // pivots since the dual's value last changed
  Eigen::VectorXd cost_;        // c over the scaled variables, length one
  Eigen::VectorXd limits_;      // of the rows of the basis
  Eigen::VectorXd y_, z_;       // multipliers and vertex of the basis
  Eigen::VectorXd direction_, slack_, entering_, ray_;

  Eigen::VectorXd x_, multipliers_;
  double value_ = 0.0;
  int iterations_ = 0;
};

}  // namespace vinerow::controllers
