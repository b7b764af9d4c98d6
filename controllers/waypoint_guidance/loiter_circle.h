#pragma once
/// Loiter circle: the course that leads onto a circle and along it.
///
/// Source: R. Beard, T. McLain, "Small Unmanned Aircraft", 2012, eq. 10.13: chi = theta + dir (pi/2
/// + atan((d - rho) / length)).

#include "controllers/waypoint_guidance/air_state.h"

namespace vinerow::controllers {

struct LoiterCircle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius_m = 30.0;
  double side = 1.0;  ///< +1: to the left, counter-clockwise; -1: to the right

  /// The circle of a vehicle with this course at this place.
  static LoiterCircle tangent(const Eigen::Vector2d& place, double course_rad, double radius_m,
                              double side) {
    const Eigen::Vector2d left(-std::sin(course_rad), std::cos(course_rad));
    return {place + side * radius_m * left, radius_m, side};
  }

  double away_m(const Eigen::Vector2d& p) const { return (p - centre).norm(); }

  /// @param length_m  distance from the circle at which the course is 45 deg off the tangent
  /// @param near_rad  the wanted course so far
  WantedCourse course(const GuidanceState& state, double length_m, double near_rad) const {
    const Eigen::Vector2d out = state.position - centre;
    const double off_m = out.norm() - radius_m;
    const double angle_rad =
        std::atan2(out.y(), out.x()) + side * (0.5 * kPi + std::atan(off_m / length_m));
    // On the circle the course turns with the position; far away it is constant.
    const double share = 1.0 / (1.0 + (off_m / length_m) * (off_m / length_m));
    return {unwrap_near(angle_rad, near_rad), side * share * state.velocity.norm() / radius_m};
  }
};

}  // namespace vinerow::controllers
