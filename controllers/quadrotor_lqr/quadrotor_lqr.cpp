#include "controllers/quadrotor_lqr/quadrotor_lqr.h"

#include "controllers/parts/rotorcraft/flight_ports.h"
#include "controllers/quadrotor_lqr/quadrotor_lqr_law.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

struct QuadrotorLqrParams {
  LqrParams law;
  FlightLimitParams limits;
};

const ParameterTable<QuadrotorLqrParams>& quadrotor_lqr_table() {
  using P = QuadrotorLqrParams;
  using Law = LqrParams;
  const auto law = [](auto member) { return inside(&P::law, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers("position_weight", "1/m2", law(&Law::position_per_m2), kPositive,
                   "weight of squared position errors: horizontal, vertical")
          .numbers("velocity_weight", "s2/m2", law(&Law::velocity_per_mps2), kNotNegative,
                   "weight of squared speed errors: horizontal, vertical")
          .numbers("angle_weight", "1/rad2", law(&Law::angle_per_rad2), kPositive,
                   "weight of squared angle errors: roll and pitch, yaw")
          .numbers("rate_weight", "s2/rad2", law(&Law::rate_per_radps2), kNotNegative,
                   "weight of squared rate errors: roll and pitch, yaw")
          .number("thrust_weight", "s4/m2", law(&Law::thrust_weight), kPositive,
                  "weight of squared thrust per mass")
          .numbers("torque_weight", "s4/rad2", law(&Law::torque_weight), kPositive,
                   "weight of squared torques per inertia: roll and pitch, yaw")
          .number(
              "disturbance_s", "s", law(&Law::disturbance_s), between(0.0, 100.0),
              "time constant of the estimate of wind and load (0 = off, steady wind then leaves "
              "an error)")
          .include(&P::limits, flight_limit_table());
  return table;
}

std::string describe(const ControllerContext& context) {
  return context.part + " (quadrotor_lqr)";
}

QuadrotorLqrParams read_params(const ParameterSet& parameters, const ControllerContext& context) {
  QuadrotorLqrParams params = quadrotor_lqr_table().read(parameters, describe(context));
  params.law.period_s = context.period.s();
  return params;
}

class QuadrotorLqr final : public Controller {
 public:
  QuadrotorLqr(const QuadrotorLqrParams& params, const ControllerContext& context)
      : ports_(context, "quadrotor_lqr"),
        law_(ports_.craft(), ports_.mixer(),
             make_flight_limits(params.limits, ports_.craft(), ports_.mixer()), params.law,
             describe(context)) {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (!ports_.is_flying()) {
      ports_.write_off(now);
      was_flying_ = false;
      return;
    }
    if (!was_flying_) {
      // A flight that does not start with a take-off starts in the air.
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
  PartSpec spec;
  spec.name = "quadrotor_lqr";
  spec.description =
      "Linear quadratic regulator of the hover model (paper A, section 4.2, without constraints) "
      "for rotorcraft, with feed-forward of the reference and a disturbance estimate.";
  quadrotor_lqr_table().add_to(spec);
  spec.default_rate_Hz = 50.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "wrench", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_quadrotor_lqr(const ParameterSet& parameters,
                                               const ControllerContext& context) {
  return std::make_unique<QuadrotorLqr>(read_params(parameters, context), context);
}

}  // namespace vinerow::controllers
