#include "controllers/trmpc/trmpc.h"

#include "controllers/parts/aircraft_mpc.h"
#include "engine/core/error.h"

namespace vinerow {
namespace {

constexpr const char* kType = "trmpc";

TubeLaw read_law(const std::string& name) {
  if (name == "fixed_start") return TubeLaw::kFixedStart;
  if (name == "propagated") return TubeLaw::kPropagated;
  if (name == "printed") return TubeLaw::kPrinted;
  return TubeLaw::kTube;
}

std::vector<double> read_gain(const ParameterSet& parameters, const char* name,
                              const std::string& who) {
  const bool is_wanted = parameters.text("gain") == "given";
  if (is_wanted && !parameters.has(name)) {
    throw ConfigError(who + ": gain is 'given', so " + name + " must be");
  }
  return is_wanted ? parameters.numbers(name) : std::vector<double>{};
}

AircraftTubeParams read(const ParameterSet& parameters, const std::string& who) {
  AircraftTubeParams params;
  params.horizon = static_cast<int>(parameters.integer("horizon"));
  params.gust_mps = parameters.number("gust_mps");
  params.limits = read_aircraft_limits(parameters);
  params.weights = read_aircraft_weights(parameters);
  params.law = read_law(parameters.text("law"));
  params.shape = parameters.text("tube_shape") == "box" ? TubeShape::kBox : TubeShape::kInvariant;
  params.longitudinal_gain = read_gain(parameters, "longitudinal_gain", who);
  params.lateral_gain = read_gain(parameters, "lateral_gain", who);
  return params;
}

}  // namespace

PartSpec trmpc_spec() {
  PartSpec spec;
  spec.name = kType;
  spec.description =
      "Tube-based robust model predictive control about the reference's steady flight "
      "(Mammarella et al. 2022, eq. 8-20, corrected) for vehicles on wings: deviations and "
      "controls "
      "keep their limits in every gust up to a given strength.";
  spec.parameters = {
      integer_parameter("horizon", 20, 1, 60, "N: ticks of the controller that it looks ahead"),
      positive_parameter("gust_mps", "m/s", 1.0,
                         "strongest gust along each axis of the body that limits are kept in; one "
                         "too strong for the limits is refused with the largest feasible one"),
      choice_parameter("law", "tube", {"tube", "fixed_start", "propagated", "printed"},
                       "where the nominal state starts: free within the tube, at the state, by its "
                       "own model; printed: at the state and K x counted twice, as paper A prints"),
      choice_parameter("tube_shape", "invariant", {"invariant", "box"},
                       "what the state must keep to about the nominal one: an invariant set, or "
                       "the box around the smallest one, which is faster and promises less"),
      choice_parameter("gain", "lqr", {"lqr", "given"},
                       "feedback that keeps the tube: LQR of the weights, or the lists given"),
      optional(number_list_parameter("longitudinal_gain", "", {},
                                     "K of u = K x: throttle then elevator (rad), each of u, w "
                                     "(m/s), q (rad/s), theta (rad), h (m)",
                                     10)),
      optional(number_list_parameter("lateral_gain", "", {},
                                     "K of u = K x: aileron (rad) of v (m/s), p, r (rad/s), phi, "
                                     "psi (rad)",
                                     5)),
      aircraft_weight_parameter(),
      aircraft_limit_parameter(),
  };
  describe_aircraft_mpc_signals(spec);
  return spec;
}

std::unique_ptr<Controller> make_trmpc(const ParameterSet& parameters,
                                       const ControllerContext& context) {
  return make_aircraft_mpc(context, kType, read(parameters, context.part + " (" + kType + ")"));
}

}  // namespace vinerow
