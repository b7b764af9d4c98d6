#pragma once
/// Lens of a camera: directions of its pixels, and pixels of directions.
///
/// Optical frame: x to the right, y down, z along the axis. Pixel (0, 0) is the middle of the upper
/// left pixel.
///
/// brown_conrady (Brown 1971; OpenCV, ROS plumb_bob), with r^2 = x^2 + y^2 of x = X/Z, y = Y/Z:
///   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
///   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y
/// fisheye (Kannala, Brandt 2006; OpenCV fisheye, ROS equidistant), with the angle t to the axis:
///   x' = t' X / sqrt(X^2 + Y^2), t' = t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8)
/// Pixel: u = fx x' + cx, v = fy y' + cy.

#include <Eigen/Core>
#include <optional>

#include "engine/api/messages/camera.h"

namespace vinerow {

class Lens {
 public:
  explicit Lens(const CameraInfo& info) : info_(info) {}

  int width() const { return static_cast<int>(info_.width); }
  int height() const { return static_cast<int>(info_.height); }
  const CameraInfo& info() const { return info_; }

  /// Unit direction of a point of the picture, in the optical frame. @param u,v  px
  /// @returns nullopt if the lens folds between the axis and this point, so that no single
  /// direction belongs to it
  std::optional<Eigen::Vector3d> direction(double u, double v) const;
  /// @returns nullopt if it is behind the camera (brown_conrady) or beyond the lens's range
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& direction) const;

 private:
  Eigen::Vector2d distorted(const Eigen::Vector2d& p) const;
  Eigen::Matrix2d slope(const Eigen::Vector2d& p) const;
  double fisheye_radius(double angle) const;
  double fisheye_slope(double angle) const;

  CameraInfo info_;
};

}  // namespace vinerow
