#pragma once
/// Common cameras as pure functions of poses.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/render/scene.h"

namespace vinerow::render {

/// Camera at `eye_W` that has `target_W` in its centre and the horizon level.
/// @pre eye_W != target_W; looking straight down or up, the top of the picture is north.
Camera look_at(const Eigen::Vector3d& eye_W, const Eigen::Vector3d& target_W,
               double fov_rad = 0.96);

struct ChaseOptions {
  double distance_m = 5.0;  ///< behind the vehicle, horizontally
  double height_m = 2.2;    ///< above it (and above the line of its slope)
  double side_rad = 0.0;    ///< angle of the eye around the vehicle, positive to the left
  double target_ahead_m = 1.5;
  double target_height_m = 0.3;
  double fov_rad = 0.96;
  /// true: the camera pitches with the body's x axis. Not suitable for rotorcraft, which pitch to
  /// accelerate.
  bool follows_slope = true;
};

/// Camera that follows a vehicle uphill and downhill with a level horizon; roll is ignored.
Camera chase_camera(const Pose& X_WB, const ChaseOptions& options = {});

/// Orthographic view from above, north up, that shows the whole box.
/// @param aspect  width / height of the picture
/// @param margin  free border as a share of the box
Camera top_camera(const Eigen::AlignedBox3d& box_W, double aspect, double margin = 0.06);

/// Camera fixed to a body. @param X_BS  mounting; S has x forward, y left, z up
Camera on_board_camera(const Pose& X_WB, const Pose& X_BS, double fov_rad = 1.2);

/// Pixel coordinates (origin: upper left corner of the picture) of a point, by the pinhole model.
/// @returns false if the point is behind a perspective camera
bool project(const Camera& camera, int width, int height, const Eigen::Vector3d& p_W,
             Eigen::Vector2d& pixel);

}  // namespace vinerow::render
