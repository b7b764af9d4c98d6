#pragma once
/// What a winged vehicle tells about its flight mechanics: the loads of air and propulsion, as a
/// pure function. Trim, linearisation and model-based controllers stand on it, and the vehicle's
/// own physics uses the same function, so that a controller's model is the simulator's.

#include <Eigen/Core>
#include <span>

namespace vinerow {

/// Where the air meets the vehicle.
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

  /// @param actuators  where the actuators stand now (not what they are told), in the order and
  /// units of VehicleDescription::actuators. Smooth enough for central differences. No heap.
  virtual AirLoad load(const AirPoint& air, std::span<const double> actuators) const = 0;

  virtual double mass_kg() const = 0;
  /// About B's origin, in B, kg m2.
  virtual Eigen::Matrix3d inertia_B() const = 0;
};

}  // namespace vinerow
