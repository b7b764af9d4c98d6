#include "controllers/fixed_wing_lqr/fixed_wing_lqr.h"

#include "controllers/parts/aircraft/aircraft_ports.h"
#include "controllers/parts/aircraft/aircraft_weights.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

struct FixedWingLqrParams {
  AircraftWeights weights;
  AircraftLimits limits;
};

const ParameterTable<FixedWingLqrParams>& fixed_wing_lqr_table() {
  using P = FixedWingLqrParams;
  static const ParameterTable<P> table = ParameterTable<P>()
                                             .include(&P::weights, aircraft_weight_table())
                                             .include(&P::limits, aircraft_limit_table());
  return table;
}

std::string who(const ControllerContext& context) {
  return context.part + " (fixed_wing_lqr)";
}

class FixedWingLqr final : public Controller {
 public:
  FixedWingLqr(const FixedWingLqrParams& params, const ControllerContext& context)
      : ports_(context, "fixed_wing_lqr", params.limits) {
    const AircraftLaws laws = make_aircraft_laws(ports_.aircraft(), ports_.trims().cruise().level(),
                                                 context.period.s(), params.weights, who(context));
    K_lon_ = laws.lon.K;
    K_lat_ = laws.lat.K;
  }

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (!ports_.is_flying()) {
      ports_.write_off(now);
      return;
    }
    ports_.take_over();
    if (ports_.is_launching()) {
      ports_.write_launch(now);
      return;
    }
    const Eigen::Vector2d lon = K_lon_ * ports_.deviation().lon;
    ports_.write(now, {lon.x(), lon.y(), K_lat_.dot(ports_.deviation().lat)});
  }

  bool finished() const override { return ports_.has_ended(); }

 private:
  AircraftPorts ports_;
  Eigen::Matrix<double, 2, 5> K_lon_;
  Eigen::Matrix<double, 1, 5> K_lat_;
};

}  // namespace

PartSpec fixed_wing_lqr_spec() {
  PartSpec spec;
  spec.name = "fixed_wing_lqr";
  spec.description =
      "Linear quadratic regulator about the reference's steady flight (paper A, section 2, without "
      "constraints and tube) for fixed-wing vehicles.";
  fixed_wing_lqr_table().add_to(spec);
  spec.default_rate_Hz = 20.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "deviation", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_fixed_wing_lqr(const ParameterSet& parameters,
                                                const ControllerContext& context) {
  return std::make_unique<FixedWingLqr>(fixed_wing_lqr_table().read(parameters, who(context)),
                                        context);
}

}  // namespace vinerow::controllers
