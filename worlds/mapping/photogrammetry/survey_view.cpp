#include "worlds/mapping/photogrammetry/survey_view.h"

#include <algorithm>
#include <cmath>

namespace vinerow::mapping {

SurveyView::SurveyView(const SurveyCamera& camera, const Pose& X_WS)
    : R_SW_(X_WS.q.toRotationMatrix().transpose()),
      p_WS_(X_WS.p),
      f_u_(camera.focal_length_mm / camera.sensor_width_mm * camera.columns),
      f_v_(camera.focal_length_mm / camera.sensor_height_mm * camera.rows),
      tan_across_(0.5 * camera.sensor_width_mm / camera.focal_length_mm),
      tan_along_(0.5 * camera.sensor_height_mm / camera.focal_length_mm) {}

bool SurveyView::shows(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d p_S = R_SW_ * (p_W - p_WS_);
  return p_S.x() > 0.0 && std::abs(p_S.y()) < tan_across_ * p_S.x() &&
         std::abs(p_S.z()) < tan_along_ * p_S.x();
}

double SurveyView::outside_m(const Eigen::Vector3d& p_S) const {
  const double across_m =
      (std::abs(p_S.y()) - tan_across_ * p_S.x()) / std::hypot(1.0, tan_across_);
  const double along_m = (std::abs(p_S.z()) - tan_along_ * p_S.x()) / std::hypot(1.0, tan_along_);
  return std::max(across_m, along_m);
}

bool SurveyView::may_show(const Eigen::Vector3d& centre_W, double radius_m) const {
  const Eigen::Vector3d p_S = R_SW_ * (centre_W - p_WS_);
  return p_S.x() > -radius_m && outside_m(p_S) < radius_m;
}

bool SurveyView::shows_all(const Eigen::Vector3d& centre_W, double radius_m) const {
  const Eigen::Vector3d p_S = R_SW_ * (centre_W - p_WS_);
  return p_S.x() > radius_m && outside_m(p_S) < -radius_m;
}

Eigen::Vector2d SurveyView::pixel(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d p_S = R_SW_ * (p_W - p_WS_);
  return {-f_u_ * p_S.y() / p_S.x(), -f_v_ * p_S.z() / p_S.x()};
}

Eigen::Matrix<double, 2, 3> SurveyView::jacobian(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d p_S = R_SW_ * (p_W - p_WS_);
  const double per_m = 1.0 / p_S.x();
  Eigen::Matrix<double, 2, 3> J;
  J.row(0) = -f_u_ * per_m * (R_SW_.row(1) - p_S.y() * per_m * R_SW_.row(0));
  J.row(1) = -f_v_ * per_m * (R_SW_.row(2) - p_S.z() * per_m * R_SW_.row(0));
  return J;
}

}  // namespace vinerow::mapping
