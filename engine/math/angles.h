#pragma once
/// Angle conversion and wrapping. Yaw and steering are positive to the left (counter-clockwise seen
/// from above).

#include <cmath>
#include <numbers>

namespace vinerow {

constexpr double kPi = std::numbers::pi;

constexpr double rad_from_deg(double angle_deg) {
  return angle_deg * (kPi / 180.0);
}
constexpr double deg_from_rad(double angle_rad) {
  return angle_rad * (180.0 / kPi);
}

/// Equivalent angle in (-pi, pi]. @param angle_rad finite
inline double wrap_angle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// Chord of an arc per length of the arc, sin(h) / h, with h half of the angle that it turns.
inline double chord_per_arc(double half_turn_rad) {
  return std::abs(half_turn_rad) < 1e-8 ? 1.0 : std::sin(half_turn_rad) / half_turn_rad;
}

}  // namespace vinerow
