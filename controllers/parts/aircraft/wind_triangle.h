#pragma once
/// The wind triangle: velocity over ground = velocity through the air + wind.

#include <Eigen/Core>

namespace vinerow::controllers {

/// Heading and ground speed that follow a course.
struct Crab {
  double angle_rad = 0.0;         ///< heading minus course, positive to the left, |.| <= pi/2
  double ground_speed_mps = 0.0;  ///< along the course; negative: blown back
  /// False if the wind across the course exceeds the airspeed, or if the vehicle is blown back.
  bool is_possible = true;
};

/// @param wind  in plan view, m/s  @param airspeed_mps  > 0
Crab calc_crab(double course_rad, const Eigen::Vector2d& wind, double airspeed_mps);

/// Velocity over ground in plan view of a heading.
Eigen::Vector2d calc_ground_velocity(double heading_rad, const Eigen::Vector2d& wind,
                                     double airspeed_mps);

}  // namespace vinerow::controllers
