#include "controllers/path_follower/path_follower.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/parts/ground_drive/drive_ports.h"
#include "controllers/parts/paths/path_watch.h"
#include "controllers/path_follower/path_follower_law.h"
#include "controllers/path_follower/slip_estimate.h"
#include "engine/api/may_fail.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

/// All parameters of the controller; one that two laws use is in the first of them.
struct FollowerParams {
  PathFollowerParams law;
  SlipEstimateParams slip;
  PathWatchParams watch;
  std::optional<double> turn_effectiveness;
  double speed_gain = 1.0;
  double wheel_yaw_max_radps = 6.0;
};

std::string find_fault_in_lookahead(const FollowerParams& p) {
  if (p.law.lookahead_max_m >= p.law.lookahead_min_m) return "";
  return fmt::format("lookahead_max_m = {} m, must be >= lookahead_min_m = {} m",
                     p.law.lookahead_max_m, p.law.lookahead_min_m);
}

const ParameterTable<FollowerParams>& follower_table() {
  using P = FollowerParams;
  using Law = PathFollowerParams;
  const auto law = [](auto member) { return inside(&P::law, member); };
  const auto speed = [](auto member) { return inside(&P::law, &Law::speed, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("speed_mps", "m/s", speed(&SpeedLimits::speed_mps), kPositive,
                  "speed on straights (7 km/h)")
          .number("lookahead_s", "s", law(&Law::lookahead_s), kPositive,
                  "length over which errors decay, per speed")
          .number("lookahead_min_m", "m", law(&Law::lookahead_min_m), kPositive,
                  "smallest such length")
          .number("lookahead_max_m", "m", law(&Law::lookahead_max_m), kPositive,
                  "largest such length")
          .number("damping", "", law(&Law::damping), kPositive,
                  "damping ratio of the return to the path")
          .number("integral", "", law(&Law::integral), between(0.0, 1.0),
                  "weight of the integrated lateral error, against steady drift on slopes")
          .number("response_s", "s", law(&Law::response_s), between(0.0, 2.0),
                  "lag of the vehicle's yaw rate behind the command")
          .number("acceleration_mps2", "m/s2", speed(&SpeedLimits::acceleration_mps2), kPositive,
                  "acceleration and deceleration")
          .number("lateral_acceleration_mps2", "m/s2",
                  speed(&SpeedLimits::lateral_acceleration_mps2), kPositive,
                  "limits the speed in turns")
          .number("turn_rate_radps", "rad/s", speed(&SpeedLimits::yaw_rate_radps), kPositive,
                  "yaw rate of the planned turns: limits the speed so that v kappa stays below")
          .number("yaw_rate_max_radps", "rad/s", law(&Law::yaw_rate_max_radps), kPositive,
                  "limit of the commanded yaw rate")
          .number("min_turning_radius_m", "m", law(&Law::max_curvature_per_m), kPositive,
                  "radius of the tightest commanded curve", kInverse)
          .number("speed_gain", "", &P::speed_gain, between(0.0, 5.0),
                  "share of a speed error that the wheel speeds compensate")
          .number("wheel_yaw_max_radps", "rad/s", &P::wheel_yaw_max_radps, kPositive,
                  "limit of the yaw rate of the wheel speeds: spinning tyres hold no slope")
          .number("turn_effectiveness", "", &P::turn_effectiveness, between(0.2, 1.25),
                  "yaw rate of the vehicle per yaw rate of the wheels, at the start; default from "
                  "the vehicle (track_m / effective_track_m), else 1")
          .number("slide_arm_m", "m", inside(&P::slip, &SlipEstimateParams::arm_m),
                  between(-0.6, 0.6),
                  "distance ahead of its centre of the point that the vehicle turns about, at the "
                  "start")
          .number("slip_learn_s", "s", inside(&P::slip, &SlipEstimateParams::learn_time_s),
                  between(0.0, 1e3),
                  "time constant of the estimates of slip and slide; 0 = constant")
          .number("goal_tolerance_m", "m", law(&Law::goal_tolerance_m), kPositive,
                  "distance before the path's end at which the mission ends")
          .include(&P::watch, path_watch_table())
          .rule(find_fault_in_lookahead);
  return table;
}

FollowerParams read_params(const ParameterSet& parameters, const ControllerContext& context) {
  FollowerParams params = follower_table().read(parameters, context.part + " (path_follower)");
  params.law.cycle_s = context.period.s();
  params.slip.response_s = params.law.response_s;
  params.law.speed.corner_m = params.law.lookahead_min_m;
  const VehicleDescription& vehicle = *context.vehicle_description;
  if (vehicle.ackermann) {
    // Its wheels do not slide: it turns about a point on its rear axle's line, always.
    params.slip.arm_m = -vehicle.ackermann->rear_axle_m;
    params.slip.learns_arm = false;
  }
  if (params.turn_effectiveness) {
    params.slip.effectiveness = *params.turn_effectiveness;
  } else if (vehicle.wheeled && vehicle.wheeled->effective_track_m > 0.0) {
    params.slip.effectiveness = vehicle.wheeled->track_m / vehicle.wheeled->effective_track_m;
  }
  return params;
}

constexpr double kOverspeedFilter_s = 0.1;

PathFollowerParams slow_down(PathFollowerParams law, double reachable_mps) {
  law.speed.speed_mps = reachable_mps;
  return law;
}

class PathFollower final : public Controller, public MayFail {
 public:
  PathFollower(const FollowerParams& params, const ControllerContext& context)
      : ports_(context, "path_follower"),
        wanted_mps_(params.law.speed.speed_mps),
        law_(slow_down(params.law, ports_.reachable_mps(wanted_mps_))),
        slip_(params.slip),
        watch_(params.watch),
        period_s_(context.period.s()),
        speed_gain_(params.speed_gain),
        wheel_yaw_max_radps_(params.wheel_yaw_max_radps),
        overspeed_share_(1.0 - std::exp(-period_s_ / kOverspeedFilter_s)) {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (ports_.has_new_plan()) {
      law_.set_path(ports_.plan());
      watch_.reset();
      fault_ = ports_.find_fault_in_plan();
      ports_.report_slower_speed(now, wanted_mps_);
    }
    VelocityCommand command;
    if (ports_.has_estimate() && !watch_.is_lost() && fault_.empty()) {
      const Odometry& estimate = ports_.estimate();
      slip_.update(wheels_.yaw_rate_radps, estimate.w_WB_B.z(), estimate.v_WB_B.head<2>(),
                   period_s_);
      overspeed_mps_ += overspeed_share_ * (estimate.v_WB_B.x() - commanded_mps_ - overspeed_mps_);
      law_.set_stop(ports_.stop_at_m());
      const bool was_finished = law_.finished();
      command = law_.step(ports_.pose(), slip_.slide(), overspeed_mps_);
      if (law_.has_path() && !was_finished) watch(command.v_mps);
    }
    // The wheels turn harder than the vehicle should, to compensate for slip.
    commanded_mps_ = command.v_mps;
    wheels_ = command;
    if (command.v_mps > 0.0)
      wheels_.v_mps = std::max(command.v_mps - speed_gain_ * overspeed_mps_, 0.0);
    wheels_.yaw_rate_radps = std::clamp(command.yaw_rate_radps / slip_.effectiveness(),
                                        -wheel_yaw_max_radps_, wheel_yaw_max_radps_);
    wheels_ = ports_.drive().limit(wheels_);
    FollowerState state = law_.state();
    state.finished = finished();
    ports_.write(now, command, wheels_, state);
  }

  bool finished() const override { return law_.finished() && !watch_.is_lost(); }
  std::string_view failure() const override {
    return fault_.empty() ? watch_.failure() : std::string_view(fault_);
  }

 private:
  void watch(double speed_mps) {
    const FollowerState state = law_.state();
    watch_.update({ports_.pose().p, law_.path().pose_at(state.distance_m, state.waypoint).p,
                   state.distance_m, law_.path().length_m(), speed_mps * period_s_,
                   law_.finished()});
  }

  DrivePorts ports_;
  double wanted_mps_;  ///< on straights
  PathFollowerLaw law_;
  SlipEstimate slip_;
  PathWatch watch_;
  std::string fault_;  ///< of the plan
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
      "error over a lookahead that grows with speed; brakes for turns; estimates the slip of a "
      "skid-steered vehicle.";
  follower_table().add_to(spec);
  spec.default_rate_Hz = 40.0;
  spec.reads = {"estimate", "plan", "authority"};
  spec.writes = {"actuators", "command", "follower", "controller_event"};
  return spec;
}

std::unique_ptr<Controller> make_path_follower(const ParameterSet& parameters,
                                               const ControllerContext& context) {
  return std::make_unique<PathFollower>(read_params(parameters, context), context);
}

}  // namespace vinerow::controllers
