#pragma once
/// Double Ackermann steering: angles of four wheels that all roll about one centre.
///
/// An axle angle is that of a bicycle's wheel in the middle of the axle. The two axle angles
/// determine the instantaneous centre of rotation and so the direction of every wheel (ideal
/// Ackermann mechanism on both axles, linked by the steering computer). For a body that moves with
/// the direction s = v_y / v_x and the curvature k = w / v_x of its origin,
///
///   k = (tan d_F - tan d_R) / (a + b),   s = (b tan d_F + a tan d_R) / (a + b),
///   tan d_ij = (s + k x_ij) / (1 - k y_ij).
///
/// Source: paper A (Biosystems Engineering 2022), eq. 25-28 and figure 17, with angles positive to
/// the left on both axles. Frames: B, x forward, y left.

#include <array>
#include <cmath>

namespace vinerow::vehicles {

struct TwoAxles {
  double front_m = 0.75;  ///< a: front axle ahead of the origin, > 0
  double rear_m = 0.75;   ///< b: rear axle behind the origin, > 0
  double track_m = 0.85;  ///< wheel centre to wheel centre
};

/// @param front_rad,rear_rad  axle angles, |angle| < pi/2, the centre of rotation not under the
/// hull
/// @returns wheel angles, front left, front right, rear left, rear right
inline std::array<double, 4> calc_wheel_angles(const TwoAxles& axles, double front_rad,
                                               double rear_rad) {
  const double base_m = axles.front_m + axles.rear_m;
  const double front = std::tan(front_rad), rear = std::tan(rear_rad);
  const double k = (front - rear) / base_m;
  // s + k x is the axle's own tangent: k a + s = tan d_F, s - k b = tan d_R.
  const double left = 1.0 - 0.5 * k * axles.track_m, right = 1.0 + 0.5 * k * axles.track_m;
  return {std::atan2(front, left), std::atan2(front, right), std::atan2(rear, left),
          std::atan2(rear, right)};
}

}  // namespace vinerow::vehicles
