#pragma once
/// Kinematics of a vehicle with two steered axles: from axle angles to curvature, ICR, wheel angles
/// and wheel speeds.
///
/// Source: paper A (Mammarella et al. 2022), section 4.1, eq. 27-29. The angle of an axle is that
/// of a wheel in its middle ("bicycle" angle). A linkage turns the left and right wheel so that all
/// axes meet in one instantaneous centre of rotation (ICR). With x forward, y left, the front axle
/// at x = a, the rear one at x = -b:
///   k, s                                      of engine/math/axle_roll.h
///   ICR = (-s / k, 1 / k)
///   tan d_ij = (s + k x_ij) / (1 - k y_ij)    wheel at (x_ij, y_ij)
/// There is no division by k: the distance of a wheel from the ICR is r_ij = reach_ij / k, and only
/// the reach is needed, the wheel's speed per forward speed. So straight driving, crab and nearly
/// parallel axles are no special cases.

#include <Eigen/Core>

#include "engine/math/axle_roll.h"

namespace vinerow::controllers {

/// Number of wheels; their order is front left, front right, rear left, rear right.
constexpr int kWheels = 4;

struct AxleGeometry {
  double front_m = 0.75;  ///< a: front axle ahead of B's origin
  double rear_m = 0.75;   ///< b: rear axle behind B's origin, positive
  double track_m = 0.85;
  double wheel_radius_m = 0.2;

  double wheel_base_m() const { return front_m + rear_m; }
  /// Position of a wheel in B, m.
  Eigen::Vector2d wheel_B(int wheel) const;
};

/// The one rolling motion that two axle angles allow, independent of the speed.
struct Rolling {
  double curvature_per_m = 0.0;  ///< k, yaw rate per forward speed
  double drift = 0.0;            ///< s, lateral per forward speed of B's origin
  Eigen::Vector4d wheel_rad = Eigen::Vector4d::Zero();  ///< in (-pi/2, pi/2]
  /// Rim speed of each wheel per forward speed of B's origin; negative if the ICR is between the
  /// wheel and the vehicle's middle.
  Eigen::Vector4d reach = Eigen::Vector4d::Ones();

  /// Forward speed of B's origin when its speed is `speed_mps` (signed): v_x = v / sqrt(1 + s^2).
  double forward_mps(double speed_mps) const;
  double yaw_rate_radps(double speed_mps) const { return curvature_per_m * forward_mps(speed_mps); }
  /// Rim speeds of the wheels without any slip, m/s.
  Eigen::Vector4d rim_mps(double speed_mps) const { return reach * forward_mps(speed_mps); }
  /// Yaw rate per speed along the path, 1/m: the curvature of the origin's track.
  double track_curvature_per_m() const;
  /// Direction of travel of the origin seen from B, rad.
  double side_slip_rad() const;
  /// (-s / k, 1 / k), infinite if the axles are parallel.
  Eigen::Vector2d icr_B() const;
};

/// @param axles  each within (-pi/2, pi/2)
Rolling calc_rolling(const AxleGeometry& geometry, const AxleAngles& axles);

/// The speed, reduced if a wheel's rim would exceed its limit; the curvature stays.
double limit_speed(const Rolling& rolling, double speed_mps, double rim_max_mps);

}  // namespace vinerow::controllers
