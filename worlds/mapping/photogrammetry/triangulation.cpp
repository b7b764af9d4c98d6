#include "worlds/mapping/photogrammetry/triangulation.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace vinerow::mapping {

void Triangulation::add(const SurveyView& view, const Eigen::Vector3d& p_W) {
  const Eigen::Matrix<double, 2, 3> J = view.jacobian(p_W);
  // Symmetric: Cholesky factors read the lower triangle alone.
  information_.triangularView<Eigen::Lower>() += J.transpose().lazyProduct(J);
  ++views_;
}

Eigen::Matrix3d Triangulation::covariance_m2(double match_px) const {
  const Eigen::LLT<Eigen::Matrix3d> root(information_);
  return match_px * match_px * root.solve(Eigen::Matrix3d::Identity());
}

Eigen::Vector3d Triangulation::error_m(double match_px, const Eigen::Vector3d& normals) const {
  // A = L L^T, so L^-T n has the covariance L^-T L^-1 = A^-1. Written out, because Eigen's factors
  // of any size take 2.5 times as long for three rows, once for each point of a cloud.
  const Eigen::Matrix3d& A = information_;
  Eigen::Matrix3d L;
  L(0, 0) = std::sqrt(A(0, 0));
  L(1, 0) = A(1, 0) / L(0, 0);
  L(2, 0) = A(2, 0) / L(0, 0);
  L(1, 1) = std::sqrt(A(1, 1) - L(1, 0) * L(1, 0));
  L(2, 1) = (A(2, 1) - L(2, 0) * L(1, 0)) / L(1, 1);
  L(2, 2) = std::sqrt(A(2, 2) - (L(2, 0) * L(2, 0) + L(2, 1) * L(2, 1)));
  Eigen::Vector3d x;
  x.z() = normals.z() / L(2, 2);
  x.y() = (normals.y() - L(2, 1) * x.z()) / L(1, 1);
  x.x() = (normals.x() - (L(1, 0) * x.y() + L(2, 0) * x.z())) / L(0, 0);
  return match_px * x;
}

}  // namespace vinerow::mapping
