#include "controllers/mpc_nominal/mpc_nominal.h"

#include "controllers/parts/aircraft/aircraft_mpc.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

constexpr const char* kType = "mpc_nominal";

const ParameterTable<AircraftTubeParams>& mpc_nominal_table() {
  using P = AircraftTubeParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("horizon", &P::horizon, between(1, 60),
                   "N: prediction horizon in ticks of the controller")
          .include(&P::weights, aircraft_weight_table())
          .include(&P::limits, aircraft_limit_table());
  return table;
}

}  // namespace

PartSpec mpc_nominal_spec() {
  PartSpec spec;
  spec.name = kType;
  spec.description =
      "Linear model predictive control about the reference's steady flight for fixed-wing "
      "vehicles, "
      "without a tube: the baseline of `trmpc`.";
  mpc_nominal_table().add_to(spec);
  describe_aircraft_mpc_signals(spec);
  return spec;
}

std::unique_ptr<Controller> make_mpc_nominal(const ParameterSet& parameters,
                                             const ControllerContext& context) {
  AircraftTubeParams params =
      mpc_nominal_table().read(parameters, context.part + " (" + kType + ")");
  params.gust_mps = 0.0;
  params.law = TubeLaw::kFixedStart;
  return make_aircraft_mpc(context, kType, params);
}

}  // namespace vinerow::controllers
