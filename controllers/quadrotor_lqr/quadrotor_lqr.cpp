#include "controllers/quadrotor_lqr/quadrotor_lqr.h"

#include "controllers/parts/flight_ports.h"
#include "controllers/quadrotor_lqr/quadrotor_lqr_law.h"

namespace vinerow {
namespace {

Eigen::Vector2d read_pair(const ParameterSet& parameters, const char* name) {
  const std::vector<double>& values = parameters.numbers(name);
  return {values[0], values[1]};
}

LqrParams read_params(const ParameterSet& parameters, Duration period) {
  LqrParams params;
  params.position_per_m2 = read_pair(parameters, "position_weight");
  params.velocity_per_mps2 = read_pair(parameters, "velocity_weight");
  params.angle_per_rad2 = read_pair(parameters, "angle_weight");
  params.rate_per_radps2 = read_pair(parameters, "rate_weight");
  params.thrust_weight = parameters.number("thrust_weight");
  params.torque_weight = read_pair(parameters, "torque_weight");
  params.disturbance_s = parameters.number("disturbance_s");
  params.period_s = period.s();
  return params;
}

class QuadrotorLqr final : public Controller {
 public:
  QuadrotorLqr(const ParameterSet& parameters, const ControllerContext& context)
      : ports_(context, "quadrotor_lqr"),
        law_(ports_.craft(), ports_.mixer(),
             read_flight_limits(parameters, ports_.craft(), ports_.mixer()),
             read_params(parameters, context.period), context.part + " (quadrotor_lqr)") {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (!ports_.is_flying()) {
      ports_.write_off(now);
      was_flying_ = false;
      return;
    }
    if (!was_flying_) {
      // A flight that does not begin with a take-off begins in the air.
      law_.reset(ports_.reference().phase != ReferenceTrajectory::Phase::kTakeOff);
      was_flying_ = true;
    }
    const TrajectoryPoint at = ports_.reference_at(now);
    ports_.write(now, law_.step(at, ports_.estimate(), ports_.has_lifted_off()));
    law_.command(ports_.speeds_radps());
  }

  bool finished() const override { return ports_.has_ended(); }

 private:
  FlightPorts ports_;
  QuadrotorLqrLaw law_;
  bool was_flying_ = false;
};

}  // namespace

PartSpec quadrotor_lqr_spec() {
  const LqrParams params;
  const auto pair = [](const char* name, const char* unit, const Eigen::Vector2d& values,
                       bool above_zero, const char* description) {
    ParameterSpec spec =
        number_list_parameter(name, unit, {values.x(), values.y()}, description, 2);
    spec.min = 0.0;
    spec.min_exclusive = above_zero;
    return spec;
  };
  PartSpec spec;
  spec.name = "quadrotor_lqr";
  spec.description =
      "Linear quadratic regulator of the hover model (paper A, section 4.2, without constraints) "
      "for rotorcraft, with the reference fed forward and a disturbance estimate.";
  spec.parameters = {
      pair("position_weight", "1/m2", params.position_per_m2, true,
           "weight of squared position errors: horizontal, vertical"),
      pair("velocity_weight", "s2/m2", params.velocity_per_mps2, false,
           "weight of squared speed errors: horizontal, vertical"),
      pair("angle_weight", "1/rad2", params.angle_per_rad2, true,
           "weight of squared angle errors: roll and pitch, yaw"),
      pair("rate_weight", "s2/rad2", params.rate_per_radps2, false,
           "weight of squared rate errors: roll and pitch, yaw"),
      positive_parameter("thrust_weight", "s4/m2", params.thrust_weight,
                         "weight of squared thrust per mass"),
      pair("torque_weight", "s4/rad2", params.torque_weight, true,
           "weight of squared torques per inertia: roll and pitch, yaw"),
      number_parameter("disturbance_s", "s", params.disturbance_s, 0.0, 100.0,
                       "time to learn wind and load (0 = off, steady wind then leaves an error)"),
  };
  for (ParameterSpec& limit : flight_limit_parameters()) spec.parameters.push_back(limit);
  spec.default_rate_Hz = 50.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "wrench", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_quadrotor_lqr(const ParameterSet& parameters,
                                               const ControllerContext& context) {
  return std::make_unique<QuadrotorLqr>(parameters, context);
}

}  // namespace vinerow
