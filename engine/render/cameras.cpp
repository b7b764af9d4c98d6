#include "engine/render/cameras.h"

#include <algorithm>
#include <cmath>

namespace vinerow::render {

namespace {

/// Rotation of an optical frame from its viewing direction and the direction of the picture's top.
Eigen::Quaterniond optical_rotation(const Eigen::Vector3d& forward, const Eigen::Vector3d& up) {
  Eigen::Matrix3d R_WC;
  R_WC.col(2) = forward.normalized();
  R_WC.col(0) = R_WC.col(2).cross(up).normalized();
  R_WC.col(1) = R_WC.col(2).cross(R_WC.col(0));
  return Eigen::Quaterniond(R_WC);
}

}  // namespace

Camera look_at(const Eigen::Vector3d& eye_W, const Eigen::Vector3d& target_W, double fov_rad) {
  const Eigen::Vector3d forward = (target_W - eye_W).normalized();
  const bool vertical = std::abs(forward.z()) > 0.9999;
  const Eigen::Vector3d up = vertical ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  Camera camera;
  camera.X_WC = {optical_rotation(forward, up), eye_W};
  camera.fov_rad = fov_rad;
  return camera;
}

Camera chase_camera(const Pose& X_WB, const ChaseOptions& options) {
  // Pitches with the body's x axis, but never rolls.
  const Eigen::Vector3d forward = X_WB.q * Eigen::Vector3d::UnitX();
  const double level = std::max(forward.head<2>().norm(), 0.2);
  const double slope = options.follows_slope ? forward.z() / level : 0.0;
  const double yaw = yaw_from_quaternion(X_WB.q);
  const double from = yaw + options.side_rad;
  const double back = options.distance_m;
  const Eigen::Vector3d eye =
      X_WB.p + Eigen::Vector3d(-std::cos(from) * back, -std::sin(from) * back,
                               options.height_m - slope * std::cos(options.side_rad) * back);
  const double ahead = options.target_ahead_m;
  const Eigen::Vector3d target =
      X_WB.p + Eigen::Vector3d(std::cos(yaw) * ahead, std::sin(yaw) * ahead,
                               options.target_height_m + slope * ahead);
  return look_at(eye, target, options.fov_rad);
}

Camera top_camera(const Eigen::AlignedBox3d& box_W, double aspect, double margin) {
  const Eigen::Vector3d size = box_W.sizes();
  Camera camera =
      look_at(box_W.center() + Eigen::Vector3d(0, 0, 0.5 * size.z() + 100.0), box_W.center());
  camera.orthographic = true;
  camera.ortho_height_m =
      std::max(1.0, std::max(size.y(), size.x() / aspect)) * (1.0 + 2.0 * margin);
  return camera;
}

Camera on_board_camera(const Pose& X_WB, const Pose& X_BS, double fov_rad) {
  Eigen::Matrix3d R_SC;  // columns: right, down and forward of the picture in S
  R_SC.col(0) = Eigen::Vector3d(0, -1, 0);
  R_SC.col(1) = Eigen::Vector3d(0, 0, -1);
  R_SC.col(2) = Eigen::Vector3d(1, 0, 0);
  Camera camera;
  camera.X_WC = X_WB * X_BS * Pose{Eigen::Quaterniond(R_SC), Eigen::Vector3d::Zero()};
  camera.fov_rad = fov_rad;
  return camera;
}

bool project(const Camera& camera, int width, int height, const Eigen::Vector3d& p_W,
             Eigen::Vector2d& pixel) {
  const Eigen::Vector3d p_C = camera.X_WC.inverse() * p_W;
  if (!camera.orthographic && p_C.z() <= 0.0) return false;
  const double scale = camera.orthographic
                           ? height / camera.ortho_height_m
                           : 0.5 * height / std::tan(0.5 * camera.fov_rad) / p_C.z();
  pixel = Eigen::Vector2d(0.5 * width, 0.5 * height) + scale * p_C.head<2>();
  return true;
}

}  // namespace vinerow::render
