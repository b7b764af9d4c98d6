#include "controllers/fixed_wing_pid/fixed_wing_pid.h"

#include <cmath>

#include "controllers/fixed_wing_pid/fixed_wing_pid_law.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

struct FixedWingPidParams {
  FixedWingGains gains;
  AircraftLimits limits;
};

const ParameterTable<FixedWingPidParams>& fixed_wing_pid_table() {
  using P = FixedWingPidParams;
  using G = FixedWingGains;
  constexpr ParameterRange kGain = between(0.0, 1000.0);
  const auto of = [](auto member) { return inside(&P::gains, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("height_gain", "1/s", of(&G::height_per_s), kGain,
                  "wanted climb rate per height error")
          .number("climb_limit_mps", "m/s", of(&G::climb_limit_mps), kPositive,
                  "largest climb rate towards the reference's height, in addition to its own")
          .number("climb_gain", "rad s/m", of(&G::climb_rad_per_mps), kGain,
                  "wanted pitch per climb rate error")
          .number("climb_integral", "rad/m", of(&G::climb_integral_rad_per_m), kGain,
                  "wanted pitch per second of climb rate error")
          .degrees("pitch_limit_deg", of(&G::pitch_limit_rad), kPositive,
                   "largest wanted pitch, from the steady flight's")
          .degrees("incidence_limit_deg", of(&G::incidence_limit_rad), kPositive,
                   "largest wanted angle of attack, from the steady flight's")
          .number("pitch_gain", "", of(&G::pitch), kGain, "elevator per pitch error")
          .number("pitch_rate_gain", "s", of(&G::pitch_rate_s), kGain, "elevator per pitch rate")
          .number("airspeed_gain", "s/m", of(&G::airspeed_per_mps), kGain,
                  "throttle per airspeed error")
          .number("airspeed_integral", "1/m", of(&G::airspeed_integral_per_m), kGain,
                  "throttle per second of airspeed error")
          .number("heading_gain", "", of(&G::heading), kGain, "wanted bank per heading error")
          .degrees("bank_limit_deg", of(&G::bank_limit_rad), kPositive,
                   "largest wanted bank, from the steady flight's")
          .number("bank_gain", "", of(&G::bank), kGain, "aileron per bank error")
          .number("bank_integral", "1/s", of(&G::bank_integral_per_s), kGain,
                  "aileron per second of bank error")
          .number("roll_rate_gain", "s", of(&G::roll_rate_s), kGain, "aileron per roll rate")
          .number("yaw_rate_gain", "s", of(&G::yaw_rate_s), kGain,
                  "aileron per yaw rate, which damps the dutch roll")
          .include(&P::limits, aircraft_limit_table());
  return table;
}

class FixedWingPid final : public Controller {
 public:
  FixedWingPid(const FixedWingPidParams& params, const ControllerContext& context)
      : ports_(context, "fixed_wing_pid", params.limits),
        law_(params.gains, ports_.aircraft().cruise_speed_mps, context.period.s()) {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (!ports_.is_flying()) {
      ports_.write_off(now);
      law_.reset();
      return;
    }
    ports_.take_over();
    if (ports_.is_launching()) {
      ports_.write_launch(now);
      law_.reset();
      return;
    }
    const AircraftControls requested = law_.step(ports_.deviation(), climb_beyond_reference());
    law_.learn(requested, ports_.write(now, requested));
  }

  bool finished() const override { return ports_.has_ended(); }

 private:
  double climb_beyond_reference() const {
    const Odometry& estimate = ports_.estimate();
    const AirReference& wanted = ports_.reference();
    const double climb_mps = (estimate.X_WB.q * estimate.v_WB_B).z() -
                             wanted.airspeed_mps * std::sin(wanted.climb_angle_rad);
    return std::isfinite(climb_mps) ? climb_mps : 0.0;
  }

  AircraftPorts ports_;
  FixedWingPidLaw law_;
};

}  // namespace

PartSpec fixed_wing_pid_spec() {
  PartSpec spec;
  spec.name = "fixed_wing_pid";
  spec.description =
      "Usual autopilot (successive loop closure; Beard and McLain 2012, chapter 6, without rudder) "
      "about the reference's steady flight, for fixed-wing vehicles.";
  fixed_wing_pid_table().add_to(spec);
  spec.default_rate_Hz = 20.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "deviation", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_fixed_wing_pid(const ParameterSet& parameters,
                                                const ControllerContext& context) {
  return std::make_unique<FixedWingPid>(
      fixed_wing_pid_table().read(parameters, context.part + " (fixed_wing_pid)"), context);
}

}  // namespace vinerow::controllers
