#include "controllers/trmpc/trmpc.h"

#include <fmt/format.h>

#include <optional>

#include "controllers/parts/aircraft/aircraft_mpc.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

constexpr const char* kType = "trmpc";

struct TrmpcParams {
  AircraftTubeParams tube;
  bool is_gain_given = false;
  /// Of u = K x, row by row.
  std::optional<std::vector<double>> longitudinal_gain, lateral_gain;
};

std::string find_gain_fault(const TrmpcParams& p) {
  const auto missing = [](const char* name) {
    return fmt::format("gain is 'given', so {} must be", name);
  };
  if (p.is_gain_given && !p.longitudinal_gain) return missing("longitudinal_gain");
  if (p.is_gain_given && !p.lateral_gain) return missing("lateral_gain");
  const auto unused = [](const char* name) {
    return fmt::format("{} is used only with gain 'given'", name);
  };
  if (!p.is_gain_given && p.longitudinal_gain) return unused("longitudinal_gain");
  if (!p.is_gain_given && p.lateral_gain) return unused("lateral_gain");
  return "";
}

const ParameterTable<TrmpcParams>& trmpc_table() {
  using P = TrmpcParams;
  using Tube = AircraftTubeParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("horizon", inside(&P::tube, &Tube::horizon), between(1, 60),
                   "N: prediction horizon in ticks of the controller")
          .number("gust_mps", "m/s", inside(&P::tube, &Tube::gust_mps), kPositive,
                  "strongest gust along each axis of the body under which limits are kept; one too "
                  "strong for the limits is refused with the largest feasible one")
          .choice("law", inside(&P::tube, &Tube::law),
                  {{"tube", TubeLaw::kTube},
                   {"fixed_start", TubeLaw::kFixedStart},
                   {"propagated", TubeLaw::kPropagated},
                   {"printed", TubeLaw::kPrinted}},
                  "start of the nominal state: free within the tube, at the state, by its own "
                  "model; printed: at the state, with K x counted twice, as in paper A")
          .choice("tube_shape", inside(&P::tube, &Tube::shape),
                  {{"invariant", TubeShape::kInvariant}, {"box", TubeShape::kBox}},
                  "set around the nominal state that contains the state: an invariant set, or the "
                  "box around the smallest one, which is faster but not recursively feasible")
          .choice("gain", &P::is_gain_given, {{"lqr", false}, {"given", true}},
                  "feedback of the tube: LQR of the weights, or the given lists")
          .numbers("longitudinal_gain", "", &P::longitudinal_gain, kAnyNumber,
                   "K of u = K x: throttle then elevator (rad), each of u, w "
                   "(m/s), q (rad/s), theta (rad), h (m)",
                   10)
          .numbers("lateral_gain", "", &P::lateral_gain, kAnyNumber,
                   "K of u = K x: aileron (rad) of v (m/s), p, r (rad/s), phi, "
                   "psi (rad)",
                   5)
          .include(inside(&P::tube, &Tube::weights), aircraft_weight_table())
          .include(inside(&P::tube, &Tube::limits), aircraft_limit_table())
          .rule(find_gain_fault);
  return table;
}

AircraftTubeParams read(const ParameterSet& parameters, const std::string& who) {
  TrmpcParams params = trmpc_table().read(parameters, who);
  if (params.is_gain_given) {
    params.tube.longitudinal_gain = *params.longitudinal_gain;
    params.tube.lateral_gain = *params.lateral_gain;
  }
  return params.tube;
}

}  // namespace

PartSpec trmpc_spec() {
  PartSpec spec;
  spec.name = kType;
  spec.description =
      "Tube-based robust model predictive control about the reference's steady flight "
      "(Mammarella et al. 2022, eq. 8-20, corrected) for fixed-wing vehicles: deviations and "
      "controls keep their limits in every gust up to a given strength.";
  trmpc_table().add_to(spec);
  describe_aircraft_mpc_signals(spec);
  return spec;
}

std::unique_ptr<Controller> make_trmpc(const ParameterSet& parameters,
                                       const ControllerContext& context) {
  return make_aircraft_mpc(context, kType, read(parameters, context.part + " (" + kType + ")"));
}

}  // namespace vinerow::controllers
