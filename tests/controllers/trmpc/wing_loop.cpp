#include "tests/controllers/trmpc/wing_loop.h"

#include <algorithm>
#include <cmath>

#include "controllers/fixed_wing_lqr/fixed_wing_lqr.h"
#include "controllers/mpc_nominal/mpc_nominal.h"
#include "controllers/parts/aircraft/flight_trim.h"
#include "controllers/trmpc/trmpc.h"
#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::test {

std::unique_ptr<Controller> make_wing_controller(const WingSetup& setup,
                                                 const VehicleDescription& description) {
  ControllerContext context;
  context.vehicle = "plane";
  context.part = "plane.controller";
  context.vehicle_description = &description;
  context.gravity_mps2 = setup.numbers.gravity_mps2;
  context.period = period_of_rate(setup.rate_Hz);
  const bool is_tube = setup.type == "trmpc", is_nominal = setup.type == "mpc_nominal";
  const PartSpec spec =
      is_tube ? controllers::trmpc_spec()
              : (is_nominal ? controllers::mpc_nominal_spec() : controllers::fixed_wing_lqr_spec());
  ParameterSet set(spec.parameters, spec.name);
  for (const auto& [name, value] : setup.parameters) set.set(name, value);
  if (is_tube) return controllers::make_trmpc(set, context);
  return is_nominal ? controllers::make_mpc_nominal(set, context)
                    : controllers::make_fixed_wing_lqr(set, context);
}

WingLoop::WingLoop(const WingSetup& setup)
    : setup_(setup),
      description_(describe(setup.numbers)),
      sim_(setup.numbers),
      controller_(make_wing_controller(setup, description_)),
      period_(period_of_rate(setup.rate_Hz)) {
  Ports world(bus_, "plane", "test");
  estimate_ = world.write<Odometry>("estimate");
  reference_ = world.write<AirReference>("reference");
  Ports ports(bus_, "plane", "plane.controller");
  controller_->connect(ports);
  actuators_ = world.read<NamedValues>("actuators");
  deviation_ = world.read<NamedValues>("deviation");
  if (setup.type != "fixed_wing_lqr") {
    tube_ = world.read<NamedValues>("tube");
    event_ = world.read<Event>("controller_event");
  }
  bus_.check_connected();

  wanted_.phase = AirReference::Phase::kStraight;
  wanted_.power = true;
  wanted_.airspeed_mps = setup.numbers.cruise_speed_mps;
  wanted_.height_m = 100.0;
  const controllers::Aircraft aircraft = controllers::read_aircraft(
      description_, setup.numbers.gravity_mps2, "plane.controller (test)");
  const Result<controllers::Trim> trim =
      controllers::find_trim(aircraft, {setup.numbers.cruise_speed_mps, 0.0, 0.0});
  VINEROW_DEMAND(trim.ok());
  // East is a quarter turn clockwise from north.
  sim_.start({0.0, 0.0, 100.0 - setup.low_m}, 0.0, trim->pitch_rad, 0.5 * M_PI + setup.off_rad,
             {trim->u_mps, trim->v_mps, trim->w_mps}, Eigen::Vector3d::Zero(),
             {trim->controls.throttle, trim->controls.elevator_rad, trim->controls.aileron_rad});
}

void WingLoop::tick(const Eigen::Vector3d& gust,
                    const std::function<void(const std::function<void()>& decide)>& around) {
  estimate_.write(now_, sim_.truth());
  reference_.write(now_, wanted_);
  around([this] { controller_->step(now_); });
  if (event_.connected() && event_.is_newer_than(seen_event_)) {
    events_.push_back(event_.value().text);
  }
  sim_.set_body_gust(gust);
  const int steps = static_cast<int>(std::lround(period_.s() / setup_.physics_s));
  for (int i = 0; i < steps; ++i) sim_.step(actuators_.value().values, setup_.physics_s);
  now_ = now_ + period_;
}

double WingLoop::value_of(const NamedValues& values, const std::string& name) {
  const auto at = std::find(values.names.begin(), values.names.end(), name);
  VINEROW_DEMAND(at != values.names.end());
  return values.values[static_cast<std::size_t>(at - values.names.begin())];
}

GaussMarkovGust::GaussMarkovGust(std::uint64_t seed, double strength)
    : random_(seed, "test", "gust"), strength_(strength) {
  for (double& along : direction_) along = random_.normal();
  direction_ /= direction_.cwiseAbs().maxCoeff();  // up to 1 m/s along each axis
  value_ = 0.5 * random_.normal();
}

Eigen::Vector3d GaussMarkovGust::next() {
  const double keep = std::exp(-0.05 * 12.0 / 60.0);
  value_ = keep * value_ + 0.5 * std::sqrt(1.0 - keep * keep) * random_.normal();
  return strength_ * std::clamp(value_, -1.0, 1.0) * direction_;
}

}  // namespace vinerow::test
