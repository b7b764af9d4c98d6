#include "controllers/path_follower/path_follower.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/drive_ports.h"
#include "controllers/path_follower/path_follower_law.h"
#include "controllers/path_follower/slip_estimate.h"
#include "engine/core/error.h"

namespace vinerow {
namespace {

PathFollowerParams read_params(const ParameterSet& parameters, Duration period,
                               const std::string& part) {
  PathFollowerParams params;
  params.lookahead_s = parameters.number("lookahead_s");
  params.lookahead_min_m = parameters.number("lookahead_min_m");
  params.lookahead_max_m = parameters.number("lookahead_max_m");
  if (params.lookahead_max_m < params.lookahead_min_m) {
    throw ConfigError(
        fmt::format("{} (path_follower): lookahead_max_m = {} m, must be >= lookahead_min_m = {} m",
                    part, params.lookahead_max_m, params.lookahead_min_m));
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
  params.speed.yaw_rate_radps = parameters.number("turn_rate_radps");
  params.yaw_rate_max_radps = parameters.number("yaw_rate_max_radps");
  return params;
}

SlipEstimateParams read_slip(const ParameterSet& parameters, const VehicleDescription& vehicle) {
  SlipEstimateParams params;
  if (parameters.has("turn_effectiveness")) {
    params.effectiveness = parameters.number("turn_effectiveness");
  } else if (vehicle.wheeled && vehicle.wheeled->effective_track_m > 0.0) {
    params.effectiveness = vehicle.wheeled->track_m / vehicle.wheeled->effective_track_m;
  }
  params.arm_m = parameters.number("slide_arm_m");
  params.learn_time_s = parameters.number("slip_learn_s");
  params.response_s = parameters.number("response_s");
  return params;
}

constexpr double kOverspeedFilter_s = 0.1;

class PathFollower final : public Controller {
 public:
  PathFollower(const ParameterSet& parameters, const ControllerContext& context)
      : ports_(context, "path_follower"),
        law_(read_params(parameters, context.period, context.part)),
        slip_(read_slip(parameters, *context.vehicle_description)),
        period_s_(context.period.s()),
        speed_gain_(parameters.number("speed_gain")),
        wheel_yaw_max_radps_(parameters.number("wheel_yaw_max_radps")),
        overspeed_share_(1.0 - std::exp(-period_s_ / kOverspeedFilter_s)) {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (ports_.has_new_plan()) law_.set_path(ports_.plan());
    VelocityCommand command;
    if (ports_.has_estimate()) {
      const Odometry& estimate = ports_.estimate();
      slip_.update(wheels_.yaw_rate_radps, estimate.w_WB_B.z(), estimate.v_WB_B.head<2>(),
                   period_s_);
      overspeed_mps_ += overspeed_share_ * (estimate.v_WB_B.x() - commanded_mps_ - overspeed_mps_);
      law_.set_stop(ports_.stop_at_m());
      command = law_.step(ports_.pose(), slip_.slide(), overspeed_mps_);
    }
    // The wheels turn harder than the vehicle is to turn, by what slips away.
    commanded_mps_ = command.v_mps;
    wheels_ = command;
    if (command.v_mps > 0.0)
      wheels_.v_mps = std::max(command.v_mps - speed_gain_ * overspeed_mps_, 0.0);
    wheels_.yaw_rate_radps = std::clamp(command.yaw_rate_radps / slip_.effectiveness(),
                                        -wheel_yaw_max_radps_, wheel_yaw_max_radps_);
    wheels_ = ports_.drive().limit(wheels_);
    ports_.write(now, command, wheels_, law_.state());
  }

  bool finished() const override { return law_.finished(); }

 private:
  DrivePorts ports_;
  PathFollowerLaw law_;
  SlipEstimate slip_;
  double period_s_;
  double speed_gain_;
  double wheel_yaw_max_radps_;
  double overspeed_share_;
  double overspeed_mps_ = 0.0;  ///< low-passed
  double commanded_mps_ = 0.0;
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
      positive_parameter("lookahead_s", "s", 0.7, "length over which errors die out, per speed"),
      positive_parameter("lookahead_min_m", "m", 0.6, "least such length"),
      positive_parameter("lookahead_max_m", "m", 3.0, "largest such length"),
      positive_parameter("damping", "", 1.0, "damping ratio of the way back to the path"),
      number_parameter("integral", "", 0.0, 0.0, 1.0,
                       "weight of the summed lateral error, against steady drift on slopes"),
      number_parameter("response_s", "s", 0.0, 0.0, 2.0,
                       "time that the vehicle's yaw rate lags behind the command"),
      positive_parameter("acceleration_mps2", "m/s2", 0.8, "speeding up and braking"),
      positive_parameter("lateral_acceleration_mps2", "m/s2", 1.0, "slows down in turns"),
      positive_parameter("turn_rate_radps", "rad/s", 0.6,
                         "yaw rate of the planned turns: slows down so that v kappa stays below"),
      positive_parameter("yaw_rate_max_radps", "rad/s", 1.2, "limit of the commanded yaw rate"),
      positive_parameter("min_turning_radius_m", "m", 0.5, "tightest curve commanded"),
      number_parameter("speed_gain", "", 1.0, 0.0, 5.0,
                       "share of a speed too high or low that the wheels are told to make up"),
      positive_parameter("wheel_yaw_max_radps", "rad/s", 6.0,
                         "limit of the yaw rate that the wheels stand for: tyres that spin hold "
                         "no slope"),
      optional(number_parameter("turn_effectiveness", "", 1.0, 0.2, 1.25,
                                "yaw rate driven per yaw rate of the wheels, at the start; default "
                                "what the vehicle tells (track_m / effective_track_m), else 1")),
      number_parameter(
          "slide_arm_m", "m", 0.0, -0.6, 0.6,
          "the vehicle turns about a point this far ahead of its centre, at the start"),
      number_parameter("slip_learn_s", "s", 1.0, 0.0, 1e3,
                       "time over which slip and slide are learnt; 0 = kept as at the start"),
      positive_parameter("goal_tolerance_m", "m", 0.05,
                         "the mission ends this far before the path's end"),
  };
  spec.default_rate_Hz = 40.0;
  spec.reads = {"estimate", "plan", "authority"};
  spec.writes = {"actuators", "command", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_path_follower(const ParameterSet& parameters,
                                               const ControllerContext& context) {
  return std::make_unique<PathFollower>(parameters, context);
}

}  // namespace vinerow
