#include "engine/math/decomposition.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace vinerow {

template <int n>
SymmetricEigen<n> decompose_symmetric(const Eigen::Matrix<double, n, n>& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}
template SymmetricEigen<2> decompose_symmetric<2>(const Eigen::Matrix2d&);
template SymmetricEigen<3> decompose_symmetric<3>(const Eigen::Matrix3d&);
template SymmetricEigen<4> decompose_symmetric<4>(const Eigen::Matrix4d&);

Eigen::VectorXcd calc_eigenvalues(const Eigen::MatrixXd& A) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues();
}

Eigen::VectorXd solve_least_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.completeOrthogonalDecomposition().solve(b);
}

}  // namespace vinerow
