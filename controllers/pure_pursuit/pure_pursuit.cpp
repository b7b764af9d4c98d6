#include "controllers/pure_pursuit/pure_pursuit.h"

#include <algorithm>
#include <limits>

#include "controllers/parts/drive_ports.h"
#include "controllers/pure_pursuit/pure_pursuit_law.h"
#include "engine/math/angles.h"
#include "engine/math/deviation.h"

namespace vinerow {
namespace {

PurePursuitParams read_params(const ParameterSet& parameters, Duration period) {
  PurePursuitParams params;
  params.lookahead_m = parameters.number("lookahead_m");
  params.crossed_distance_m = parameters.has("crossed_distance_m")
                                  ? parameters.number("crossed_distance_m")
                                  : params.lookahead_m;
  params.speed_mps = parameters.number("speed_mps");
  params.steering_threshold_rad = rad_from_deg(parameters.number("steering_threshold_deg"));
  params.largest_angle_rad = rad_from_deg(parameters.number("largest_angle_deg"));
  const double radius = parameters.number("min_turning_radius_m");
  params.yaw_rate_limit_radps =
      radius > 0.0 ? params.speed_mps / radius : std::numeric_limits<double>::infinity();
  params.turn_gain = parameters.number("turn_gain");
  params.goal_tolerance_m = parameters.number("goal_tolerance_m");
  params.aim_at_goal = parameters.boolean("aim_at_goal");
  params.cycle_s = period.s();
  return params;
}

class PurePursuit final : public Controller {
 public:
  PurePursuit(const ParameterSet& parameters, const ControllerContext& context)
      : ports_(context, "pure_pursuit"),
        law_(read_params(parameters, context.period)),
        stop_(parameters.number("stop_mps2")) {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (ports_.has_new_plan()) take_plan();
    VelocityCommand command;
    FollowerState state;
    if (law_.has_path() && ports_.has_estimate()) {
      const Pose2 pose = ports_.pose();
      command = law_.step(pose);
      state = describe(pose);
      command = limit(command, state);
    }
    ports_.write(now, command, state);
  }

  bool finished() const override { return law_.finished(); }

 private:
  void take_plan() {
    law_.set_path(ports_.plan());
    stop_.reset();
    if (law_.has_path()) polyline_ = PolylineDistance(law_.points());
  }

  /// No farther than the movement authority.
  VelocityCommand limit(VelocityCommand command, const FollowerState& state) {
    stop_.set_place(ports_.stop_at_m());
    command.v_mps = std::min(command.v_mps, stop_.update(state.distance_m));
    if (stop_.is_holding()) command.yaw_rate_radps = 0.0;
    return command;
  }

  /// Errors from the polyline near the current index; the law itself does not use them.
  FollowerState describe(const Pose2& pose) const {
    constexpr int kBehind = 8, kAhead = 2;
    const auto nearest =
        polyline_.nearest_within(pose.p, law_.index() - kBehind, law_.index() + kAhead);
    const Eigen::Vector2d along =
        polyline_.points()[nearest.segment + 1] - polyline_.points()[nearest.segment];
    FollowerState state;
    state.lateral_error_m = nearest.signed_distance_m;
    state.heading_error_rad = wrap_angle(pose.yaw_rad - std::atan2(along.y(), along.x()));
    state.distance_m = law_.points().size() < 2
                           ? 0.0
                           : law_.distance_m(nearest.segment) + nearest.fraction * along.norm();
    state.remaining_m = law_.length_m() - state.distance_m;
    state.waypoint = law_.index();
    state.finished = law_.finished();
    return state;
  }

  DrivePorts ports_;
  PurePursuitLaw law_;
  StopProfile stop_;
  PolylineDistance polyline_;
};

}  // namespace

PartSpec pure_pursuit_spec() {
  PartSpec spec;
  spec.name = "pure_pursuit";
  spec.description =
      "Lookahead follower of Martelli, Mocera, Soma 2024 (eq. 1-7): local goal point on the "
      "lookahead "
      "circle, current index, steering threshold; wheel speeds of a speed-steered vehicle.";
  spec.parameters = {
      positive_parameter("lookahead_m", "m", 0.75, "radius LD of the lookahead circle"),
      optional(
          positive_parameter("crossed_distance_m", "m", 0.75,
                             "a waypoint nearer than this (D_th) is crossed; default lookahead_m, "
                             "the only choice without endless loops")),
      positive_parameter("speed_mps", "m/s", 7.0 / 3.6, "speed v_t on the straight (7 km/h)"),
      number_parameter("steering_threshold_deg", "deg", 0.0, 0.0, 180.0,
                       "smaller steering angles count as zero (table 3: 2.5)"),
      positive_parameter("largest_angle_deg", "deg", 360.0, "theta_max of the speed law (eq. 7)"),
      number_parameter("min_turning_radius_m", "m", 1.0, 0.0, 1e3,
                       "limits the yaw rate to speed / radius (table 1); 0 = no limit"),
      positive_parameter("turn_gain", "", 1.0,
                         "share of the steering angle turned in one cycle; 1 = eq. 6, less for "
                         "vehicles with inertia"),
      positive_parameter("goal_tolerance_m", "m", 0.1,
                         "the mission ends this near the last waypoint (or one cycle's way)"),
      positive_parameter("stop_mps2", "m/s2", 0.8,
                         "braking where a movement authority ends; the paper's law has none"),
      boolean_parameter("aim_at_goal", true,
                        "aim at the last waypoint once it is within lookahead_m; false = literally "
                        "the paper, which may never arrive"),
  };
  spec.default_rate_Hz = 40.0;
  spec.reads = {"estimate", "plan", "authority"};
  spec.writes = {"actuators", "command", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_pure_pursuit(const ParameterSet& parameters,
                                              const ControllerContext& context) {
  return std::make_unique<PurePursuit>(parameters, context);
}

}  // namespace vinerow
