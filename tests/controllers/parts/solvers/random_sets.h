#pragma once
/// Random matrices, systems and sets, and what tests of sets ask of them.

#include <Eigen/Eigenvalues>
#include <string>

#include "controllers/parts/solvers/polytope.h"
#include "engine/core/error.h"
#include "engine/core/random.h"

namespace vinerow::test {

/// Normal entries, column by column.
inline Eigen::MatrixXd normal_matrix(RandomStream& random, Eigen::Index rows,
                                     Eigen::Index columns) {
  Eigen::MatrixXd matrix(rows, columns);
  for (double& entry : matrix.reshaped()) entry = random.normal();
  return matrix;
}

/// A random system with the spectral radius `radius`.
inline Eigen::MatrixXd random_system(RandomStream& random, int n, double radius) {
  const Eigen::MatrixXd A = normal_matrix(random, n, n);
  return A * (radius / A.eigenvalues().cwiseAbs().maxCoeff());
}

/// `rows` half-spaces about the origin, within the box of these half widths.
inline controllers::Polytope random_constraints(RandomStream& random, const Eigen::VectorXd& box,
                                                int rows) {
  Eigen::VectorXd g(rows);
  for (double& limit : g) limit = random.uniform(0.5, 1.5);
  return controllers::Polytope(normal_matrix(random, rows, box.size()), g)
      .intersection(controllers::Polytope::box(box));
}

/// The same within the box |x_i| <= 2.
inline controllers::Polytope random_constraints(RandomStream& random, int n, int rows) {
  return random_constraints(random, Eigen::VectorXd::Constant(n, 2.0), rows);
}

inline bool same_set(const controllers::Polytope& P, const controllers::Polytope& Q) {
  return P.contains(Q) && Q.contains(P);
}

/// The message of the ConfigError that the action throws, "none" where it throws none.
template <typename Action>
std::string complaint(Action&& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace vinerow::test
