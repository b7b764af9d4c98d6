#pragma once
/// What the laws of the waypoint guidance know of vehicle and air at one tick.

#include <Eigen/Core>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {

/// In W; plan view where it is two numbers.
struct GuidanceState {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double height_m = 0.0;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< over ground, m/s
  double climb_mps = 0.0;
  double yaw_rad = 0.0;
  double bank_left_rad = 0.0;
  Eigen::Vector2d wind = Eigen::Vector2d::Zero();  ///< mean, m/s

  double course_rad() const { return std::atan2(velocity.y(), velocity.x()); }
  double airspeed_mps() const { return std::hypot((velocity - wind).norm(), climb_mps); }
};

/// A direction as events tell it: whole degrees from north, clockwise, 0 to 359.
inline double bearing_deg(double yaw_rad) {
  const double rounded = std::round(90.0 - deg_from_rad(wrap_angle(yaw_rad)));
  return rounded < 0.0 ? rounded + 360.0 : rounded;
}

/// What a law wants: course over ground, not wrapped, and how fast it changes.
struct WantedCourse {
  double course_rad = 0.0;
  double rate_radps = 0.0;
};

/// The angle of this direction that is nearest to another one.
inline double unwrap_near(double angle_rad, double near_rad) {
  return near_rad + wrap_angle(angle_rad - near_rad);
}

}  // namespace vinerow::controllers
