#include "controllers/four_wheel_steering/axle_geometry.h"

#include <cmath>

namespace vinerow::controllers {

Eigen::Vector2d AxleGeometry::wheel_B(int wheel) const {
  return {wheel < 2 ? front_m : -rear_m, (wheel % 2 == 0 ? 0.5 : -0.5) * track_m};
}

double Rolling::forward_mps(double speed_mps) const {
  return speed_mps / std::sqrt(1.0 + drift * drift);
}

double Rolling::track_curvature_per_m() const {
  return curvature_per_m / std::sqrt(1.0 + drift * drift);
}

double Rolling::side_slip_rad() const {
  return std::atan(drift);
}

Eigen::Vector2d Rolling::icr_B() const {
  return {-drift / curvature_per_m, 1.0 / curvature_per_m};
}

Rolling calc_rolling(const AxleGeometry& geometry, const AxleAngles& axles) {
  const AxleRoll roll = calc_axle_roll(geometry.front_m, geometry.rear_m, axles);
  Rolling rolling;
  rolling.curvature_per_m = roll.curvature_per_m;
  rolling.drift = roll.drift;
  for (int i = 0; i < kWheels; ++i) {
    // Velocity of the wheel's centre per forward speed of the origin.
    const Eigen::Vector2d p = geometry.wheel_B(i);
    const double along = 1.0 - rolling.curvature_per_m * p.y();
    const double across = rolling.drift + rolling.curvature_per_m * p.x();
    // A wheel that the ICR has passed rolls backwards instead of turning by 180 deg.
    const double sign = along < 0.0 ? -1.0 : 1.0;
    rolling.wheel_rad[i] = std::atan2(sign * across, sign * along);
    rolling.reach[i] = sign * std::hypot(along, across);
  }
  return rolling;
}

double limit_speed(const Rolling& rolling, double speed_mps, double rim_max_mps) {
  const double fastest_mps = rolling.rim_mps(speed_mps).cwiseAbs().maxCoeff();
  return fastest_mps > rim_max_mps ? speed_mps * (rim_max_mps / fastest_mps) : speed_mps;
}

}  // namespace vinerow::controllers
