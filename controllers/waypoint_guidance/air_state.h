#pragma once
/// State of vehicle and air at one tick, for the laws of the waypoint guidance.

#include <Eigen/Core>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {

/// In W; two-dimensional vectors are in plan view.
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

/// A direction as in events: whole degrees from north, clockwise, 0 to 359.
inline double bearing_deg(double yaw_rad) {
  const double rounded = std::round(90.0 - deg_from_rad(wrap_angle(yaw_rad)));
  return rounded < 0.0 ? rounded + 360.0 : rounded;
}

/// Wanted course over ground, not wrapped, and its rate.
struct WantedCourse {
  double course_rad = 0.0;
  double rate_radps = 0.0;
};

/// The equivalent angle that is nearest to another angle.
inline double unwrap_near(double angle_rad, double near_rad) {
  return near_rad + wrap_angle(angle_rad - near_rad);
}

}  // namespace vinerow::controllers
