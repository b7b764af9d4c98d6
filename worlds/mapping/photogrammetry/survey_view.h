#pragma once
/// Picture of a survey: a pinhole camera with its pose.
///
/// S as in CameraShot: x along the optical axis, y to the picture's left, z up in it. A point
/// (x, y, z) in S is at u = -f_u y / x, v = -f_v z / x, pixels from the picture's middle to the
/// right and down, with f_u = focal_length / sensor_width * columns, f_v likewise.

#include <Eigen/Core>

#include "engine/api/survey_camera.h"
#include "engine/math/pose.h"

namespace vinerow::mapping {

class SurveyView {
 public:
  SurveyView(const SurveyCamera& camera, const Pose& X_WS);

  const Eigen::Vector3d& p_WS() const { return p_WS_; }
  Eigen::Vector3d axis_W() const { return R_SW_.row(0).transpose(); }
  /// True if the point is in front of the camera and within the picture.
  bool shows(const Eigen::Vector3d& p_W) const;
  /// False only if no part of the ball is in the picture.
  bool may_show(const Eigen::Vector3d& centre_W, double radius_m) const;
  /// True only if the whole ball is in the picture.
  bool shows_all(const Eigen::Vector3d& centre_W, double radius_m) const;
  /// Pixels from the picture's middle. @pre in front of the camera
  Eigen::Vector2d pixel(const Eigen::Vector3d& p_W) const;
  /// d pixel / d p_W, pixels per metre. @pre in front of the camera
  Eigen::Matrix<double, 2, 3> jacobian(const Eigen::Vector3d& p_W) const;

 private:
  /// Larger one of the outward distances from the planes through the camera and the picture's
  /// edges.
  double outside_m(const Eigen::Vector3d& p_S) const;

  Eigen::Matrix3d R_SW_;
  Eigen::Vector3d p_WS_;
  double f_u_, f_v_;               ///< pixels
  double tan_across_, tan_along_;  ///< of half the angles of view
};

}  // namespace vinerow::mapping
