#include "controllers/mpc_nominal/mpc_nominal.h"

#include "controllers/parts/aircraft_mpc.h"

namespace vinerow {
namespace {

constexpr const char* kType = "mpc_nominal";

}  // namespace

PartSpec mpc_nominal_spec() {
  PartSpec spec;
  spec.name = kType;
  spec.description =
      "Linear model predictive control about the reference's steady flight for vehicles on wings, "
      "without a tube: what `trmpc` is compared with.";
  spec.parameters = {
      integer_parameter("horizon", 20, 1, 60, "N: ticks of the controller that it looks ahead"),
      aircraft_weight_parameter(),
      aircraft_limit_parameter(),
  };
  describe_aircraft_mpc_signals(spec);
  return spec;
}

std::unique_ptr<Controller> make_mpc_nominal(const ParameterSet& parameters,
                                             const ControllerContext& context) {
  AircraftTubeParams params;
  params.horizon = static_cast<int>(parameters.integer("horizon"));
  params.gust_mps = 0.0;
  params.limits = read_aircraft_limits(parameters);
  params.weights = read_aircraft_weights(parameters);
  params.law = TubeLaw::kFixedStart;
  return make_aircraft_mpc(context, kType, params);
}

}  // namespace vinerow
