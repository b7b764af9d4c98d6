#pragma once
/// Model of a rotorcraft for controllers, from its VehicleDescription, and the linear model about
/// hover derived from it.

#include <Eigen/Core>
#include <string>

#include "engine/api/vehicle.h"

namespace vinerow::controllers {

/// The vehicle's record, extended by the data that hovering needs.
struct RotorcraftModel : Rotorcraft {
  double mass_kg = 1.0;
  double gravity_mps2 = 9.80665;

  double max_thrust_N() const {
    return static_cast<double>(rotors.size()) * thrust_coefficient_Ns2 * max_rotor_radps *
           max_rotor_radps;
  }
  double hover_rotor_radps() const;
};

/// @throws ConfigError "drone.controller needs a vehicle with rotors; vehicle type 'x' has wheels";
/// numbers that no rotorcraft has; "the rotors lift 15.2 N at most, less than the weight of 19.6 N"
RotorcraftModel read_rotorcraft(const VehicleDescription& description, double gravity_mps2,
                                const std::string& who);

/// x' = A x + B u about hover, in the frame that is turned about z with the wanted yaw.
/// State: position (3, m), velocity (3, m/s), roll, pitch, yaw error (rad), body rates p, q, r
/// (rad/s); with lag four more, the wrench that acts: thrust minus weight (N), torques (N m).
/// Input: the wanted wrench, thrust minus weight (N) and torques about x, y, z (N m).
/// With lag the yaw torque has a lead: a change dw of the rotor speeds turns the body at once by
/// J_r dw / dt, which during the first lag is several times the resulting drag torque k_M w^2
/// (about hover tau = tau_drag + J_r / (2 w k_M) dtau_drag / dt).
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
/// @throws ConfigError if with_lag is set and the craft's rotors lack a lag
HoverModel make_hover_model(const RotorcraftModel& craft, bool with_lag);

}  // namespace vinerow::controllers
