#pragma once
/// What a controller knows of a vehicle that flies on rotors, all told by its VehicleDescription,
/// and the linear model about hover that comes of it.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/api/vehicle.h"

namespace vinerow {

/// One rotor; its thrust is along +z of B.
struct RotorPlace {
  Eigen::Vector2d p_B = {0, 0};  ///< hub, m
  double torque_sign = 1.0;      ///< +1: its drag torque turns the body to the left (+z)
};

struct Rotorcraft {
  double mass_kg = 1.0;
  Eigen::Vector3d inertia_kgm2 = {1, 1, 1};  ///< about B's axes
  std::vector<RotorPlace> rotors;
  double thrust_coefficient = 0.0;  ///< k_F, thrust = k_F w^2, N s2
  double torque_coefficient = 0.0;  ///< k_M, drag torque = k_M w^2, N m s2
  double min_rotor_radps = 0.0;
  double max_rotor_radps = 0.0;
  double rotor_lag_s = 0.05;         ///< first-order lag of the rotor's speed
  /// Of one rotor about its axis. A rotor that is spun up pushes the body the way its drag does.
  double rotor_inertia_kgm2 = 0.0;
  double rotor_drag_Ns_per_m = 0.0;  ///< all rotors together: force = - this * air velocity
  double gravity_mps2 = 9.80665;

  double max_thrust_N() const {
    return static_cast<double>(rotors.size()) * thrust_coefficient * max_rotor_radps *
           max_rotor_radps;
  }
  double hover_rotor_radps() const;
};

/// Reads the numbers `rotor_count`, `rotor_<i>_x_m`, `rotor_<i>_y_m`, `rotor_<i>_torque_sign`
/// (i from 1), `rotor_thrust_coefficient`, `rotor_torque_coefficient`, `rotor_min_radps`,
/// `rotor_max_radps`, `rotor_lag_s`, `rotor_drag_Ns_per_m`, `inertia_xx_kgm2`, `inertia_yy_kgm2`,
/// `inertia_zz_kgm2`; `rotor_inertia_kgm2` where it is told.
/// @throws ConfigError "drone.controller needs 'rotor_count', which vehicle type 'x' does not
/// tell"; numbers that no rotorcraft has; "the rotors lift 15.2 N at most, less than the weight
/// of 19.6 N"
Rotorcraft read_rotorcraft(const VehicleDescription& description, double gravity_mps2,
                           const std::string& who);

/// x' = A x + B u about hover, in the frame that is turned about z with the wanted yaw.
/// State: position (3, m), velocity (3, m/s), roll, pitch, yaw error (rad), body rates p, q, r
/// (rad/s); with lag four more, the wrench that acts: thrust less weight (N), torques (N m).
/// Input: the wanted wrench, thrust less weight (N) and torques about x, y, z (N m).
/// With lag the yaw torque has a lead: spinning rotors up by dw turns the body at once, J_r dw / dt,
/// which in the first lag is several times the drag torque k_M w^2 that it leads to (about hover
/// tau = tau_drag + J_r / (2 w k_M) dtau_drag / dt).
/// No wind, no rotor inertia: x' = v, v' = g (pitch, -roll, 0) + (0, 0, thrust) / m - drag / m v,
/// angles' = rates, rates' = torques / J, wrench' = (wanted - wrench) / lag.
/// Source: paper A, section 4.2, with z up and the rotors' lag and drag added.
struct HoverModel {
  static constexpr int kStates = 12;
  static constexpr int kStatesWithLag = 16;
  static constexpr int kInputs = 4;
  Eigen::MatrixXd A;
  Eigen::MatrixXd B;
};
/// @throws ConfigError if with_lag and the craft's rotors have none
HoverModel make_hover_model(const Rotorcraft& craft, bool with_lag);

}  // namespace vinerow
