#include "engine/sensors/gnss_geometry.h"

#include <Eigen/Cholesky>

namespace vinerow::sensors {

void GnssGeometry::add(const Eigen::Vector3d& direction_W, double weight) {
  Eigen::Vector4d row;
  row << -direction_W, 1.0;
  normal_ += weight * row * row.transpose();
  ++count_;
}

bool GnssGeometry::read(Dilution& dilution) const {
  // Four satellites on one cone do not determine a position, and a dilution of 1e4 is useless.
  constexpr double kMinPivot = 1e-8;
  if (count_ < 4) return false;
  const Eigen::LDLT<Eigen::Matrix4d> factors(normal_);
  if (factors.info() != Eigen::Success || factors.vectorD().minCoeff() < kMinPivot) return false;
  const Eigen::Matrix4d Q = factors.solve(Eigen::Matrix4d::Identity());
  dilution.axes = Q.diagonal().head<3>().cwiseSqrt();
  dilution.clock = std::sqrt(Q(3, 3));
  return dilution.axes.allFinite();
}

}  // namespace vinerow::sensors
