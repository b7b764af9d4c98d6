#include "controllers/path_follower/path_follower.h"

#include "controllers/parts/drive_ports.h"
#include "controllers/path_follower/path_follower_law.h"
#include "controllers/path_follower/slip_estimate.h"

namespace vinerow {
namespace {

PathFollowerParams read_params(const ParameterSet& parameters, Duration period) {
  PathFollowerParams params;
  params.lookahead_s = parameters.number("lookahead_s");
  params.lookahead_min_m = parameters.number("lookahead_min_m");
  params.lookahead_max_m = parameters.number("lookahead_max_m");
  if (params.lookahead_max_m < params.lookahead_min_m) {
    params.lookahead_max_m = params.lookahead_min_m;
  }
  params.damping = parameters.number("damping");
  params.integral = parameters.number("integral");
  params.response_s = parameters.number("response_s");
  params.max_curvature_per_m = 1.0 / parameters.number("min_turning_radius_m");
  params.goal_tolerance_m = parameters.number("goal_tolerance_m");
  params.cycle_s = period.s();
  params.speed.speed_mps = parameters.number("speed_mps");
  params.speed.acceleration_mps2 = parameters.number("acceleration_mps2");
  params.speed.lateral_acceleration_mps2 = parameters.number("lateral_acceleration_mps2");
  params.speed.yaw_rate_radps = parameters.number("yaw_rate_max_radps");
  return params;
}

SlipEstimateParams read_slip(const ParameterSet& parameters) {
  SlipEstimateParams params;
  params.initial = parameters.number("turn_effectiveness");
  params.learn_time_s = parameters.number("slip_learn_s");
  params.response_s = parameters.number("response_s");
  return params;
}

class PathFollower final : public Controller {
 public:
  PathFollower(const ParameterSet& parameters, const ControllerContext& context)
      : ports_(context, "path_follower"),
        law_(read_params(parameters, context.period)),
        slip_(read_slip(parameters)),
        period_s_(context.period.s()) {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (ports_.has_new_plan()) law_.set_path(ports_.plan());
    VelocityCommand command;
    if (ports_.has_estimate()) {
      slip_.update(wheels_.yaw_rate_radps, ports_.estimate().w_WB_B.z(), period_s_);
      command = law_.step(ports_.pose());
    }
    // The wheels turn harder than the vehicle is to turn, by what slips away.
    wheels_ = command;
    wheels_.yaw_rate_radps /= slip_.effectiveness();
    wheels_ = ports_.drive().limit(wheels_);
    ports_.write(now, command, wheels_, law_.state());
  }

  bool finished() const override { return law_.finished(); }

 private:
  DrivePorts ports_;
  PathFollowerLaw law_;
  SlipEstimate slip_;
  double period_s_;
  VelocityCommand wheels_;
};

}  // namespace

PartSpec path_follower_spec() {
  PartSpec spec;
  spec.name = "path_follower";
  spec.description =
      "Follows straights and arcs by their own curvature plus feedback of lateral and heading "
      "error "
      "over a lookahead that grows with speed; brakes for turns; learns how a skid-steered vehicle "
      "slips.";
  spec.parameters = {
      positive_parameter("speed_mps", "m/s", 7.0 / 3.6, "speed on straights (7 km/h)"),
      positive_parameter("lookahead_s", "s", 1.0, "length over which errors die out, per speed"),
      positive_parameter("lookahead_min_m", "m", 0.8, "least such length"),
      positive_parameter("lookahead_max_m", "m", 2.0, "largest such length"),
      positive_parameter("damping", "", 1.0, "damping ratio of the way back to the path"),
      number_parameter("integral", "", 0.0, 0.0, 1.0,
                       "weight of the summed lateral error, against steady drift on slopes"),
      number_parameter("response_s", "s", 0.0, 0.0, 2.0,
                       "time that the vehicle's yaw rate lags behind the command"),
      positive_parameter("acceleration_mps2", "m/s2", 0.8, "speeding up and braking"),
      positive_parameter("lateral_acceleration_mps2", "m/s2", 1.0, "slows down in turns"),
      positive_parameter("yaw_rate_max_radps", "rad/s", 7.0 / 3.6, "limit of the yaw rate"),
      positive_parameter("min_turning_radius_m", "m", 0.5, "tightest curve commanded"),
      number_parameter("turn_effectiveness", "", 1.0, 0.25, 1.25,
                       "yaw rate driven per yaw rate of the wheels, at the start"),
      number_parameter("slip_learn_s", "s", 0.0, 0.0, 1e3,
                       "time over which that share is learnt while turning; 0 = kept"),
      positive_parameter("goal_tolerance_m", "m", 0.05,
                         "the mission ends this far before the path's end"),
  };
  spec.default_rate_Hz = 40.0;
  spec.reads = {"estimate", "plan"};
  spec.writes = {"actuators", "command", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_path_follower(const ParameterSet& parameters,
                                               const ControllerContext& context) {
  return std::make_unique<PathFollower>(parameters, context);
}

}  // namespace vinerow
