#pragma once
/// Ellipsoid that contains the true position if all errors keep their bounds. Parallel cuts
/// (controllers/estimation/row_localisation/ellipsoid.h) update it next to a filter; it is never
/// fed back to the filter as a covariance.

#include "controllers/estimation/row_localisation/echo_slab.h"
#include "controllers/estimation/row_localisation/ellipsoid.h"

namespace vinerow::controllers {

class IntegritySet {
 public:
  bool has_started() const { return has_started_; }
  /// @param shape_m2  P, symmetric positive definite
  void start(const Eigen::Vector3d& centre_W, const Eigen::Matrix3d& shape_m2);
  /// Moves the set and grows it: the smallest ellipsoid (by trace) around its sum with a ball.
  /// @param growth_m  its radius, >= 0
  void predict(const Eigen::Vector3d& displacement_W, double growth_m);
  /// @returns the status; kEmpty: the set and the slab contradict each other, and the set is
  /// unchanged
  CutStatus cut(const EchoSlab& slab);

  const Eigen::Vector3d& centre_W() const { return centre_W_; }
  const Eigen::Matrix3d& shape_m2() const { return shape_m2_; }
  bool contains(const Eigen::Vector3d& p_W) const;

 private:
  bool has_started_ = false;
  Eigen::Vector3d centre_W_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d shape_m2_ = Eigen::Matrix3d::Identity();
};

}  // namespace vinerow::controllers
