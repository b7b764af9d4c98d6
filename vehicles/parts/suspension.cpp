#include "vehicles/parts/suspension.h"

#include <algorithm>

#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {

void SuspensionParams::validate(const std::string& who) const {
  demand_positive(who, "suspension_stiffness_N_per_m", stiffness_N_per_m);
  demand_not_negative(who, "suspension_damping_Ns_per_m", damping_Ns_per_m);
  demand_not_negative(who, "design_load_N", design_load_N);
  demand_positive(who, "bump_travel_m", bump_travel_m);
  demand_not_negative(who, "bump_stiffness_N_per_m", bump_stiffness_N_per_m);
}

double calc_suspension_force(const SuspensionParams& params, double travel_m, double rate_mps) {
  const double spring = params.design_load_N + params.stiffness_N_per_m * travel_m;
  if (spring <= 0.0) return 0.0;
  const double bump =
      params.bump_stiffness_N_per_m * std::max(0.0, travel_m - params.bump_travel_m);
  return std::max(0.0, spring + bump + params.damping_Ns_per_m * rate_mps);
}

}  // namespace vinerow::vehicles
