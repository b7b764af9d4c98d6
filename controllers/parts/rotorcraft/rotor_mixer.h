#pragma once
/// Mixer from a wanted wrench to rotor speeds, within the limits of the rotors.
///
/// Inside the limits the mixer is exact. Outside it keeps roll and pitch torque first, then thrust,
/// then yaw torque, so that a saturated vehicle stays upright. If roll and pitch alone are too
/// large they are scaled together, which keeps their direction.
///
/// The thrusts of the rotors are f = s r + T t + y c, the pseudo-inverse's shares of roll and pitch
/// torque, thrust and yaw torque. In this order, each in closed form from least <= f <= most:
///   1. s in [0, 1] as large as any thrust allows, without yaw torque;
///   2. T as near to the wanted thrust as s r allows, without yaw torque;
///   3. y in [0, 1] as large as s r + T t allows.
/// So yaw uses the remaining range and never costs thrust or attitude.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/rotorcraft/rotorcraft.h"

namespace vinerow::controllers {

struct Wrench {
  double thrust_N = 0.0;                               ///< along +z of B
  Eigen::Vector3d torque_B = Eigen::Vector3d::Zero();  ///< N m
};

class RotorMixer {
 public:
  /// @throws ConfigError if the rotors cannot make all four of thrust and torques, or if one of
  /// them would have to pull down for level thrust (they are all on one side)
  RotorMixer(const RotorcraftModel& craft, const std::string& who);

  /// Writes rotor speeds, rad/s. @returns the wrench that these speeds make. No heap.
  /// @param speeds_radps  as many as rotors
  Wrench mix(const Wrench& wanted, std::vector<double>& speeds_radps);
  /// The wrench of given speeds.
  Wrench wrench_of(const std::vector<double>& speeds_radps) const;
  /// Largest torque about each axis at hover thrust, N m: box limits for controllers.
  Eigen::Vector3d torque_limits_at_hover() const;

 private:
  double largest_roll_pitch_share() const;
  double nearest_thrust_N(double wanted_N) const;
  double largest_yaw_share(double torque_Nm) const;

  RotorcraftModel craft_;
  double min_N_ = 0.0, max_N_ = 0.0;   ///< of one rotor
  Eigen::MatrixXd wrench_of_thrusts_;  ///< 4 x rotors: thrust, torques
  Eigen::MatrixXd thrusts_of_wrench_;  ///< its pseudo-inverse
  Eigen::VectorXd thrusts_N_, roll_pitch_N_;
};

}  // namespace vinerow::controllers
