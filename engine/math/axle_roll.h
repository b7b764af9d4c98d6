#pragma once
/// Kinematics of a vehicle with two steered axles, independent of its speed.
///
/// Paper A (Mammarella et al. 2022), section 4.1 as corrected: with axle ("bicycle") angles d_F,
/// d_R, positive to the left, the front axle at x = +a and the rear axle at x = -b,
///   k = (tan d_F - tan d_R) / (a + b)        yaw rate per forward speed
///   s = (b tan d_F + a tan d_R) / (a + b)    lateral per forward speed of the origin
/// and both axles have v_F cos d_F = v_R cos d_R, the forward speed.

#include <cmath>

namespace vinerow {

/// Angles in the middle of both axles, rad, each within (-pi/2, pi/2).
struct AxleAngles {
  double front_rad = 0.0;
  double rear_rad = 0.0;
};

struct AxleRoll {
  double curvature_per_m = 0.0;  ///< k
  double drift = 0.0;            ///< s
};

/// @param front_m,rear_m  a and b, both positive
inline AxleRoll calc_axle_roll(double front_m, double rear_m, const AxleAngles& axles) {
  const double front = std::tan(axles.front_rad), rear = std::tan(axles.rear_rad);
  const double base_m = front_m + rear_m;
  return {(front - rear) / base_m, (rear_m * front + front_m * rear) / base_m};
}

}  // namespace vinerow
