#pragma once
/// Motion of a wheeled vehicle in the plane from the speeds of its wheels and the angles of its
/// axles, if every wheel rolls without slip.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "engine/api/vehicle.h"
#include "engine/math/axle_roll.h"

namespace vinerow::sensors {

/// Of B's origin, in B.
struct PlanarTwist {
  Eigen::Vector2d v_mps = {0, 0};
  double yaw_rate_radps = 0.0;
};

/// Steered vehicles. A forward speed v_x means the yaw rate k v_x and the lateral speed s v_x of
/// the origin (axle_roll.h). The hub of a wheel at (x, y) moves by (1 - k y, s + k x) per forward
/// metre; f is the length of that vector. The rims, each with the speed u, give v_x = sum(f u) /
/// sum(f^2): least squares.
///
/// Skid steering. The hubs at y move forward by v_x - g y w, with the yaw rate w and
/// g = effective track / track; v_x and w by least squares. The origin does not move sideways.
class WheelMotion {
 public:
  /// @param who  in errors, "rover.sensors.odom"
  /// @throws ConfigError if the vehicle has no wheels, or the places or radius of its wheels are
  ///   unknown
  WheelMotion(const VehicleDescription& vehicle, const std::string& who);

  /// @param actuators  angles and speeds, in the vehicle's order
  /// @param radii_m  of each wheel() as the vehicle assumes it
  /// @param track_scale  assumed track per true track; of skid-steered vehicles only
  PlanarTwist solve(std::span<const double> actuators, std::span<const double> radii_m,
                    double track_scale) const;
  /// Standard deviations of what solve() gives, to first order: of v_x, and of the yaw rate.
  /// @param stds  of the readings, in the actuators' order  @param readings  scratch, as actuators
  Eigen::Vector2d calc_std(std::span<const double> actuators, std::span<const double> stds,
                           std::vector<double>& readings) const;

  const std::vector<WheelPlace>& wheels() const { return wheels_; }
  double radius_m() const { return radius_m_; }

 private:
  AxleRoll roll_of(std::span<const double> actuators) const;
  double path_per_metre(const AxleRoll& roll, const Eigen::Vector2d& p_B) const;
  PlanarTwist solve_skid(std::span<const double> actuators, std::span<const double> radii_m,
                         double track_scale) const;

  std::vector<WheelPlace> wheels_;
  std::vector<double> true_radii_m_;  ///< of each wheel
  double radius_m_ = 0.0;
  bool is_steered_ = false;
  double front_m_ = 0.0;     ///< a
  double rear_m_ = 0.0;      ///< b
  int front_actuator_ = 0;   ///< of the axle's angle
  int rear_actuator_ = -1;   ///< -1: the rear axle does not steer
  double slip_scale_ = 1.0;  ///< g
};

}  // namespace vinerow::sensors
