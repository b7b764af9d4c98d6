#pragma once
/// How far a vehicle on wings may be from its reference: the constraints X and U of paper A's
/// tube-based MPC. Defaults: the relaxed limits of the reference of paper A, section 1 ("10 %" and
/// "20 %" of the paper are no ranges about zero).

#include <Eigen/Core>
#include <vector>

#include "engine/api/parameters.h"

namespace vinerow {

struct AircraftLimits {
  /// |u| m/s, |w| m/s, |q| rad/s, |theta| rad, |h| m
  Eigen::Matrix<double, 5, 1> lon;
  /// |v| m/s, |p| rad/s, |r| rad/s, |phi| rad, |psi| rad
  Eigen::Matrix<double, 5, 1> lat;
  double throttle = 0.25;
  double elevator_rad = 0.0;
  double aileron_rad = 0.0;

  AircraftLimits();
};

/// Group `limits`: u_mps 2.4, w_mps 3, q_degps 150, theta_deg 20, h_m 15, throttle 0.25,
/// elevator_deg 10, v_mps 5, p_degps 250, r_degps 120, phi_deg 45, psi_deg 30, aileron_deg 12.
ParameterSpec aircraft_limit_parameter();
AircraftLimits read_aircraft_limits(const ParameterSet& parameters);

}  // namespace vinerow
