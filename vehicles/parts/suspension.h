#pragma once
/// Spring-damper strut along the body's z axis: suspension and tyre carcass in series as one
/// spring.
///
///   S = max(0, S0 + k d + k_b max(0, d - d_max) + c dd/dt),  S = 0 once the spring hangs free
///
/// d is the hub's travel from its design position, positive when compressed; S0 the load at the
/// design position, so that a vehicle on level ground rests exactly as drawn.

#include <string>

namespace vinerow::vehicles {

struct SuspensionParams {
  double stiffness_N_per_m = 30000.0;      ///< k, > 0
  double damping_Ns_per_m = 1200.0;        ///< c, >= 0
  double design_load_N = 0.0;              ///< S0, >= 0
  double bump_travel_m = 0.05;             ///< d_max, > 0
  double bump_stiffness_N_per_m = 200000;  ///< k_b, >= 0

  /// @throws ConfigError
  void validate(const std::string& who) const;
  /// Travel at which the spring carries no load, <= 0.
  double droop_m() const { return -design_load_N / stiffness_N_per_m; }
};

/// @param travel_m,rate_mps  d and dd/dt, positive in compression
/// @returns strut force, N, >= 0
double calc_suspension_force(const SuspensionParams& params, double travel_m, double rate_mps);

}  // namespace vinerow::vehicles
