#pragma once
/// Convex polyhedra {x : F x <= g} by their half-spaces, bounded or not, possibly empty. Queries
/// solve linear programmes (linear_programme.h), accurate to about 1e-9 of the sizes in them. For
/// the set-up of controllers, not for their steps: everything here uses heap.
///
/// Errors: ConfigError, one sentence, if sizes do not fit, a number is not finite, or a linear
/// programme does not terminate.
/// Source: Borrelli, Bemporad, Morari, "Predictive Control for Linear and Hybrid Systems", 2017,
/// chapter 4 (operations).

#include <Eigen/Core>

namespace vinerow::controllers {

class Polytope {
 public:
  /// @param F  m x n, n >= 1; m = 0: the whole space @param g  m. All finite.
  Polytope(Eigen::MatrixXd F, Eigen::VectorXd g);
  /// lower <= x <= upper, infinite for no limit; lower > upper makes it empty.
  static Polytope box(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
  /// |x_i| <= half_i
  static Polytope box(const Eigen::VectorXd& half) { return box(-half, half); }
  /// A single row 0'x <= -1.
  static Polytope empty_set(int dimension);

  int dimension() const { return static_cast<int>(F_.cols()); }
  int rows() const { return static_cast<int>(F_.rows()); }
  const Eigen::MatrixXd& F() const { return F_; }
  const Eigen::VectorXd& g() const { return g_; }

  /// max c'x; +infinity if unbounded, -infinity if empty.
  double support(const Eigen::VectorXd& c) const;
  double operator()(const Eigen::VectorXd& c) const { return support(c); }

  /// Every row is satisfied to within `tolerance` times its length.
  bool contains(const Eigen::VectorXd& x, double tolerance = 0.0) const;
  /// Every point of `other` is inside, to within `tolerance` times the length of each row.
  bool contains(const Polytope& other, double tolerance = 1e-9) const;
  bool is_empty() const;

  /// The points in both sets.
  Polytope intersection(const Polytope& other) const;
  /// {x : A x in this}. @param A  dimension() x n
  Polytope linear_preimage(const Eigen::MatrixXd& A) const;
  /// {factor x : x in this}. @param factor  > 0
  Polytope scaled(double factor) const;
  /// The same set without rows that others imply (to within 1e-9), in the same order. Of repeated
  /// rows the last is kept; an empty set becomes empty_set().
  Polytope without_redundant_rows() const;

 private:
  Eigen::MatrixXd F_;  // m x n
  Eigen::VectorXd g_;  // m
};

}  // namespace vinerow::controllers
