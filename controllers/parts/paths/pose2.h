#pragma once
/// Poses in the horizontal plane and motion along arcs of constant curvature.

#include <Eigen/Core>
#include <cmath>

#include "engine/math/angles.h"
#include "engine/math/planar.h"

namespace vinerow::controllers {

/// Position in W and heading, rad, counter-clockwise from x.
struct Pose2 {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
};

/// Unit vector of a heading.
inline Eigen::Vector2d direction(double yaw_rad) {
  return {std::cos(yaw_rad), std::sin(yaw_rad)};
}

/// Pose after an arc: chord length sin(h)/h, direction yaw + h, with h half the turned angle.
/// @param length_m  along the arc, negative backwards
/// @param turn_rad  heading change over the whole arc, positive to the left
inline Pose2 advance(const Pose2& pose, double length_m, double turn_rad) {
  const double half = 0.5 * turn_rad;
  return {pose.p + length_m * chord_per_arc(half) * direction(pose.yaw_rad + half),
          pose.yaw_rad + turn_rad};
}

}  // namespace vinerow::controllers
