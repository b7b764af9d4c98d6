#pragma once
/// Observer of the forces and torques that the model lacks: wind, a wrong mass, an off-centre load.
/// The force is kept in W, so it survives turns, the torque in B, with which a load moves.
///
/// Each tick compares the acceleration between two estimates with that of rotors, weight and still
/// air, and takes over 1 - exp(-T / time_s) of the difference (a first-order disturbance observer).
/// Used in prediction and targets, it removes the offset: Pannocchia, Rawlings, "Disturbance models
/// for offset-free model-predictive control", AIChE J. 49(2), 2003.

#include <Eigen/Core>

#include "controllers/parts/rotorcraft/rotor_mixer.h"

namespace vinerow::controllers {

class FlightDisturbance {
 public:
  /// @param time_s  time constant; 0: estimates nothing
  FlightDisturbance(const RotorcraftModel& craft, double time_s, bool learns_torque,
                    double period_s);

  /// Sets all estimates to zero.
  void reset();
  /// One tick. @param mean  the rotors' mean wrench since the last one
  /// @param learn  false: only remembers the state, e.g. while the ground carries the vehicle
  void update(const Odometry& odometry, const Wrench& mean, bool learn);

  /// Unexplained acceleration, m/s2 in W.
  const Eigen::Vector3d& acceleration_W() const { return acceleration_W_; }
  /// Unexplained angular acceleration, rad/s2 in B.
  const Eigen::Vector3d& angular_B() const { return angular_B_; }

 private:
  RotorcraftModel craft_;
  double gain_;
  bool learns_torque_;
  double period_s_;
  bool has_last_ = false;
  Eigen::Vector3d v_W_, z_W_, w_B_;  ///< of the last tick
  Eigen::Vector3d acceleration_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_B_ = Eigen::Vector3d::Zero();
};

}  // namespace vinerow::controllers
