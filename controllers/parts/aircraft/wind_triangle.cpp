#include "controllers/parts/aircraft/wind_triangle.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {

Crab calc_crab(double course_rad, const Eigen::Vector2d& wind, double airspeed_mps) {
  const Eigen::Vector2d along(std::cos(course_rad), std::sin(course_rad));
  const double across_mps = -along.y() * wind.x() + along.x() * wind.y();
  const double sine = -across_mps / airspeed_mps;
  Crab crab;
  crab.angle_rad = std::asin(std::clamp(sine, -1.0, 1.0));
  crab.ground_speed_mps = airspeed_mps * std::cos(crab.angle_rad) + along.dot(wind);
  crab.is_possible = std::abs(sine) < 1.0 && crab.ground_speed_mps > 0.0;
  return crab;
}

Eigen::Vector2d calc_ground_velocity(double heading_rad, const Eigen::Vector2d& wind,
                                     double airspeed_mps) {
  return airspeed_mps * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad)) + wind;
}

}  // namespace vinerow::controllers
