#pragma once
/// The wind triangle: velocity over ground = velocity through the air + wind.

#include <Eigen/Core>

namespace vinerow::controllers {

/// What flying along a course takes.
struct Crab {
  double angle_rad = 0.0;         ///< heading less course, positive to the left, |.| <= pi/2
  double ground_speed_mps = 0.0;  ///< along the course; negative: blown back
  /// False where the wind across the course is stronger than the airspeed, or blows back.
  bool is_possible = true;
};

/// @param wind  in plan view, m/s  @param airspeed_mps  > 0
Crab calc_crab(double course_rad, const Eigen::Vector2d& wind, double airspeed_mps);

/// Velocity over ground in plan view of a heading.
Eigen::Vector2d calc_ground_velocity(double heading_rad, const Eigen::Vector2d& wind,
                                     double airspeed_mps);

}  // namespace vinerow::controllers
