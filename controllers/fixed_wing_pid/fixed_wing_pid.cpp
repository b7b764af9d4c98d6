#include "controllers/fixed_wing_pid/fixed_wing_pid.h"

#include <cmath>

#include "controllers/fixed_wing_pid/fixed_wing_pid_law.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

FixedWingGains read_gains(const ParameterSet& parameters) {
  FixedWingGains gains;
  gains.height_per_s = parameters.number("height_gain");
  gains.climb_limit_mps = parameters.number("climb_limit_mps");
  gains.climb_rad_per_mps = parameters.number("climb_gain");
  gains.climb_integral_rad_per_m = parameters.number("climb_integral");
  gains.pitch_limit_rad = rad_from_deg(parameters.number("pitch_limit_deg"));
  gains.incidence_limit_rad = rad_from_deg(parameters.number("incidence_limit_deg"));
  gains.pitch = parameters.number("pitch_gain");
  gains.pitch_rate_s = parameters.number("pitch_rate_gain");
  gains.airspeed_per_mps = parameters.number("airspeed_gain");
  gains.airspeed_integral_per_m = parameters.number("airspeed_integral");
  gains.heading = parameters.number("heading_gain");
  gains.bank_limit_rad = rad_from_deg(parameters.number("bank_limit_deg"));
  gains.bank = parameters.number("bank_gain");
  gains.bank_integral_per_s = parameters.number("bank_integral");
  gains.roll_rate_s = parameters.number("roll_rate_gain");
  gains.yaw_rate_s = parameters.number("yaw_rate_gain");
  return gains;
}

class FixedWingPid final : public Controller {
 public:
  FixedWingPid(const ParameterSet& parameters, const ControllerContext& context)
      : ports_(context, "fixed_wing_pid", read_aircraft_limits(parameters)),
        law_(read_gains(parameters), ports_.aircraft().cruise_speed_mps, context.period.s()) {}

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
    const AircraftControls asked = law_.step(ports_.deviation(), climb_beyond_reference());
    law_.learn(asked, ports_.write(now, asked));
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
  const FixedWingGains gains;
  const auto gain = [](const char* name, const char* unit, double value, const char* description) {
    return number_parameter(name, unit, value, 0.0, 1000.0, description);
  };
  PartSpec spec;
  spec.name = "fixed_wing_pid";
  spec.description =
      "The usual autopilot (successive loop closure; Beard and McLain 2012, chapter 6, without "
      "rudder) about the reference's steady flight, for vehicles on wings.";
  spec.parameters = {
      gain("height_gain", "1/s", gains.height_per_s, "climb rate wanted per height error"),
      positive_parameter("climb_limit_mps", "m/s", gains.climb_limit_mps,
                         "largest climb rate towards the reference's height, beside its own"),
      gain("climb_gain", "rad s/m", gains.climb_rad_per_mps, "pitch wanted per climb rate error"),
      gain("climb_integral", "rad/m", gains.climb_integral_rad_per_m,
           "pitch wanted per second of climb rate error"),
      positive_parameter("pitch_limit_deg", "deg", 15.0,
                         "largest pitch wanted, from the steady flight's"),
      positive_parameter("incidence_limit_deg", "deg", 6.0,
                         "largest angle of attack wanted, from the steady flight's"),
      gain("pitch_gain", "", gains.pitch, "elevator per pitch error"),
      gain("pitch_rate_gain", "s", gains.pitch_rate_s, "elevator per pitch rate"),
      gain("airspeed_gain", "s/m", gains.airspeed_per_mps, "throttle per airspeed error"),
      gain("airspeed_integral", "1/m", gains.airspeed_integral_per_m,
           "throttle per second of airspeed error"),
      gain("heading_gain", "", gains.heading, "bank wanted per heading error"),
      positive_parameter("bank_limit_deg", "deg", 35.0,
                         "largest bank wanted, from the steady flight's"),
      gain("bank_gain", "", gains.bank, "aileron per bank error"),
      gain("bank_integral", "1/s", gains.bank_integral_per_s, "aileron per second of bank error"),
      gain("roll_rate_gain", "s", gains.roll_rate_s, "aileron per roll rate"),
      gain("yaw_rate_gain", "s", gains.yaw_rate_s,
           "aileron per yaw rate, which damps the dutch roll"),
      aircraft_limit_parameter(),
  };
  spec.default_rate_Hz = 20.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "deviation", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_fixed_wing_pid(const ParameterSet& parameters,
                                                const ControllerContext& context) {
  return std::make_unique<FixedWingPid>(parameters, context);
}

}  // namespace vinerow
