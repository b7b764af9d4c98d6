#pragma once
/// Triangulation accuracy: covariance of a point from the rays of several pictures.
///
/// Each picture measures the point's pixel with independent errors of `match_px` in u and v. The
/// least-squares point then has the covariance match_px^2 (sum J^T J)^-1, J = d pixel / d point:
/// the usual first-order result of forward intersection (Hartley, Zisserman, "Multiple View
/// Geometry", 2nd ed., section 5.2). Across the rays that is about match_px GSD / sqrt(n), along
/// them it grows with height over baseline.

#include <Eigen/Core>

#include "worlds/mapping/photogrammetry/survey_view.h"

namespace vinerow::mapping {

class Triangulation {
 public:
  void add(const SurveyView& view, const Eigen::Vector3d& p_W);
  int views() const { return views_; }
  /// 3x3, m^2. @pre two views or more from different places
  Eigen::Matrix3d covariance_m2(double match_px) const;
  /// Error from independent standard normals, with the covariance covariance_m2().
  /// @pre as covariance_m2()
  Eigen::Vector3d error_m(double match_px, const Eigen::Vector3d& normals) const;

 private:
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();  ///< sum J^T J
  int views_ = 0;
};

}  // namespace vinerow::mapping
