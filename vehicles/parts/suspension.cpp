#include "vehicles/parts/suspension.h"

#include <algorithm>

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {
namespace {

/// Not read from files: vehicles compute these from their own parameters.
const ParameterTable<SuspensionParams>& suspension_table() {
  using P = SuspensionParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("suspension_stiffness_N_per_m", "N/m", &P::stiffness_N_per_m, kPositive,
                  "spring and tyre in series")
          .number("suspension_damping_Ns_per_m", "N s/m", &P::damping_Ns_per_m, kNotNegative,
                  "damper")
          .number("design_load_N", "N", &P::design_load_N, kNotNegative,
                  "force at the design position")
          .number("bump_travel_m", "m", &P::bump_travel_m, kPositive,
                  "compression at which the bump stop starts to act")
          .number("bump_stiffness_N_per_m", "N/m", &P::bump_stiffness_N_per_m, kNotNegative,
                  "of the bump stop");
  return table;
}

}  // namespace

void SuspensionParams::validate(const std::string& who) const {
  suspension_table().validate(*this, who);
}

double calc_suspension_force(const SuspensionParams& params, double travel_m, double rate_mps) {
  const double spring = params.design_load_N + params.stiffness_N_per_m * travel_m;
  if (spring <= 0.0) return 0.0;
  const double bump =
      params.bump_stiffness_N_per_m * std::max(0.0, travel_m - params.bump_travel_m);
  return std::max(0.0, spring + bump + params.damping_Ns_per_m * rate_mps);
}

}  // namespace vinerow::vehicles
