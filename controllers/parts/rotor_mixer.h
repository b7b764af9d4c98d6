#pragma once
/// From a wanted wrench to rotor speeds, within what the rotors can do.
///
/// Inside the limits the mixer is exact. Outside it keeps roll and pitch torque first, then thrust,
/// then yaw torque: a vehicle that cannot have all keeps upright. Where roll and pitch alone are
/// too much they are scaled together, which keeps their direction.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/rotorcraft.h"

namespace vinerow {

struct Wrench {
  double thrust_N = 0.0;                               ///< along +z of B
  Eigen::Vector3d torque_B = Eigen::Vector3d::Zero();  ///< N m
};

class RotorMixer {
 public:
  /// @throws ConfigError if the rotors cannot make all four of thrust and torques
  RotorMixer(const Rotorcraft& craft, const std::string& who);

  /// Writes rotor speeds, rad/s. @returns the wrench that these speeds make. No heap.
  Wrench mix(const Wrench& wanted, std::vector<double>& speeds_radps);
  /// What given speeds make.
  Wrench wrench_of(const std::vector<double>& speeds_radps) const;
  /// Largest torque about each axis at hover thrust, N m: box limits for controllers.
  Eigen::Vector3d torque_limits_at_hover() const;

 private:
  Rotorcraft craft_;
  Eigen::MatrixXd wrench_of_thrusts_;  ///< 4 x rotors: thrust, torques
  Eigen::MatrixXd thrusts_of_wrench_;  ///< its pseudo-inverse
  Eigen::VectorXd thrusts_N_;
};

}  // namespace vinerow
