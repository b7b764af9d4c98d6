#pragma once
/// Matrix decompositions that several libraries use. They are compiled only here, because Eigen's
/// own classes cost seconds of template instantiation in every source that uses them.

#include <Eigen/Core>

namespace vinerow {

template <int n>
struct SymmetricEigen {
  Eigen::Matrix<double, n, 1> values;   ///< ascending
  Eigen::Matrix<double, n, n> vectors;  ///< orthonormal columns, in the order of the values
};

/// A = V diag(values) V^T. No heap. @tparam n  2, 3 or 4
/// @param A  symmetric and finite; only its lower triangle is read
template <int n>
SymmetricEigen<n> decompose_symmetric(const Eigen::Matrix<double, n, n>& A);
extern template SymmetricEigen<2> decompose_symmetric<2>(const Eigen::Matrix2d&);
extern template SymmetricEigen<3> decompose_symmetric<3>(const Eigen::Matrix3d&);
extern template SymmetricEigen<4> decompose_symmetric<4>(const Eigen::Matrix4d&);

/// Eigenvalues of a square finite matrix, in no particular order; complex ones in adjacent pairs.
Eigen::VectorXcd calc_eigenvalues(const Eigen::MatrixXd& A);

/// Minimum-norm least-squares solution: the x of smallest norm among those that minimise |A x - b|,
/// for A of any shape and rank.
Eigen::VectorXd solve_least_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace vinerow
