#pragma once
/// Largest deviations of a fixed-wing vehicle from its reference: the constraints X and U of paper
/// A's tube-based MPC. Defaults: the relaxed limits of the reference of paper A, section 1 ("10 %"
/// and "20 %" of the paper are no ranges about zero).

#include "controllers/parts/aircraft/aircraft_ranges.h"

namespace vinerow::controllers {

/// Largest magnitude of each deviation, on either side.
struct AircraftLimits : AircraftRanges {
  AircraftLimits();
};

/// Group `limits`: u_mps 2.4, w_mps 3, q_degps 150, theta_deg 20, h_m 15, throttle 0.25,
/// elevator_deg 10, v_mps 5, p_degps 250, r_degps 120, phi_deg 45, psi_deg 30, aileron_deg 12.
const ParameterTable<AircraftLimits>& aircraft_limit_table();

}  // namespace vinerow::controllers
