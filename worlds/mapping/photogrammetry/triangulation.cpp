#include "worlds/mapping/photogrammetry/triangulation.h"

#include <Eigen/Cholesky>

namespace vinerow::mapping {

void Triangulation::add(const SurveyView& view, const Eigen::Vector3d& p_W) {
  const Eigen::Matrix<double, 2, 3> J = view.jacobian(p_W);
  // Symmetric: the Cholesky factors below read the lower triangle alone.
  information_.triangularView<Eigen::Lower>() += J.transpose().lazyProduct(J);
  ++views_;
}

Eigen::Matrix3d Triangulation::covariance_m2(double match_px) const {
  const Eigen::LLT<Eigen::Matrix3d> root(information_);
  return match_px * match_px * root.solve(Eigen::Matrix3d::Identity());
}

Eigen::Vector3d Triangulation::error_m(double match_px, const Eigen::Vector3d& normals) const {
  // A = L L^T, so L^-T n has the covariance L^-T L^-1 = A^-1.
  const Eigen::LLT<Eigen::Matrix3d> root(information_);
  return match_px * root.matrixU().solve(normals);
}

}  // namespace vinerow::mapping
