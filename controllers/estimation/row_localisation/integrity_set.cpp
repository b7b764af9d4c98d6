#include "controllers/estimation/row_localisation/integrity_set.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace vinerow::controllers {

void IntegritySet::start(const Eigen::Vector3d& centre_W, const Eigen::Matrix3d& shape_m2) {
  centre_W_ = centre_W;
  shape_m2_ = shape_m2;
  has_started_ = true;
}

void IntegritySet::predict(const Eigen::Vector3d& displacement_W, double growth_m) {
  centre_W_ += displacement_W;
  if (!(growth_m > 0.0)) return;
  // E((1 + 1/w) P + (1 + w) Q) contains E(P) + E(Q) for every w > 0; least trace: w^2 = tr P / tr
  // Q.
  const double w = std::sqrt(shape_m2_.trace() / 3.0) / growth_m;
  shape_m2_ *= 1.0 + 1.0 / w;
  shape_m2_.diagonal().array() += (1.0 + w) * growth_m * growth_m;
}

CutStatus IntegritySet::cut(const EchoSlab& slab) {
  return cut_ellipsoid<3>(centre_W_, shape_m2_, slab.normal_W, slab.lower_m, slab.upper_m).status;
}

bool IntegritySet::contains(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d off_W = p_W - centre_W_;
  return off_W.dot(shape_m2_.llt().solve(off_W)) <= 1.0;
}

}  // namespace vinerow::controllers
