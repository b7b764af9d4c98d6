#pragma once
/// Cost of deviations from steady flight and the LQR gains that follow from it, for
/// `fixed_wing_lqr` and for the ancillary law of the tube-based MPC. Q = diag(1 / x_i^2), R =
/// diag(1 / u_i^2) with the deviations x_i, u_i that cost 1 each. Defaults: the reference of paper
/// A, section 1.

#include <Eigen/Core>
#include <string>

#include "controllers/parts/aircraft/aircraft_linear.h"
#include "controllers/parts/aircraft/aircraft_ranges.h"

namespace vinerow::controllers {

/// The deviations that cost 1 each.
struct AircraftWeights : AircraftRanges {
  AircraftWeights();
};

/// Group `weights`: u_mps 0.6, w_mps 1, q_degps 60, theta_deg 6, h_m 2, throttle 0.1, elevator_deg
/// 4, v_mps 1.5, p_degps 90, r_degps 60, phi_deg 12, psi_deg 8, aileron_deg 4.
const ParameterTable<AircraftWeights>& aircraft_weight_table();

/// One axis with its cost and gain.
struct AxisLaw {
  SampledAxis model;
  Eigen::MatrixXd Q, R;
  Eigen::MatrixXd P;  ///< of the discrete Riccati equation
  Eigen::MatrixXd K;  ///< u = K x: the signs of paper A
};
struct AircraftLaws {
  AxisLaw lon;  ///< K 2 x 5
  AxisLaw lat;  ///< K 1 x 5
};

/// Linear models about a trim, sampled, with their LQR gains.
/// @throws ConfigError "<who>: 'weights' give no LQR gain for the longitudinal axis: ..."
AircraftLaws make_aircraft_laws(const Aircraft& aircraft, const Trim& trim, double period_s,
                                const AircraftWeights& weights, const std::string& who);

}  // namespace vinerow::controllers
