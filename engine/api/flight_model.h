#pragma once
/// Flight mechanics of a winged vehicle: aerodynamic and propulsive loads as a pure function. Trim,
/// linearisation and model-based controllers use it. The vehicle's own physics calls the same
/// function, so the controller's model equals the simulator's.

#include <Eigen/Core>
#include <span>

namespace vinerow {

/// Motion through the air, and the air's density.
struct AirPoint {
  /// Velocity of B's origin through the air, in B, m/s.
  Eigen::Vector3d v_air_B = Eigen::Vector3d::Zero();
  /// Angular velocity of B in W, in B, rad/s.
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();
  double air_density_kgm3 = 1.225;
};

/// Force and torque about B's origin, both in B; without weight.
struct AirLoad {
  Eigen::Vector3d force_B = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d torque_B = Eigen::Vector3d::Zero();  ///< N m
};

class FlightModel {
 public:
  virtual ~FlightModel() = default;

  /// Loads at the current motion and actuator positions. Smooth enough for central differences. No
  /// heap.
  /// @param actuators  current positions (not the commands), in the order and units of
  /// VehicleDescription::actuators
  virtual AirLoad load(const AirPoint& air, std::span<const double> actuators) const = 0;

  virtual double mass_kg() const = 0;
  /// About B's origin, in B, kg m2.
  virtual Eigen::Matrix3d inertia_B() const = 0;
};

}  // namespace vinerow
