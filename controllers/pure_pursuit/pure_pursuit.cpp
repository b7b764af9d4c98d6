#include "controllers/pure_pursuit/pure_pursuit.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "controllers/parts/ground_drive/drive_ports.h"
#include "controllers/parts/paths/path_watch.h"
#include "controllers/pure_pursuit/pure_pursuit_law.h"
#include "engine/api/may_fail.h"
#include "engine/api/parameter_table.h"
#include "engine/api/vehicle.h"
#include "engine/core/check.h"
#include "engine/math/angles.h"
#include "engine/math/deviation.h"

namespace vinerow::controllers {
namespace {

/// The law's parameters as in files, and those outside the law.
struct PursuitParams {
  PurePursuitParams law;
  PathWatchParams watch;
  std::optional<double> crossed_distance_m;
  std::optional<double> min_turning_radius_m;
  double stop_mps2 = 0.8;
};

const ParameterTable<PursuitParams>& pursuit_table() {
  using P = PursuitParams;
  using Law = PurePursuitParams;
  const auto law = [](auto member) { return inside(&P::law, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("lookahead_m", "m", law(&Law::lookahead_m), kPositive,
                  "radius LD of the lookahead circle")
          .number("crossed_distance_m", "m", &P::crossed_distance_m, kPositive,
                  "a waypoint nearer than this (D_th) is crossed; default lookahead_m, "
                  "the only choice without endless loops")
          .number("speed_mps", "m/s", law(&Law::speed_mps), kPositive,
                  "speed v_t on the straight (7 km/h)")
          .degrees("steering_threshold_deg", law(&Law::steering_threshold_rad), between(0.0, 180.0),
                   "smaller steering angles count as zero (table 3: 2.5)")
          .degrees("largest_angle_deg", law(&Law::largest_angle_rad), kPositive,
                   "theta_max of the speed law (eq. 7)")
          .number(
              "min_turning_radius_m", "m", &P::min_turning_radius_m, between(0.0, 1e3),
              "limits the commanded yaw rate to speed / radius; 0 = no limit; default: 1 (table "
              "1), and 0 for a vehicle with an effective_track_m above its track_m, whose wheels "
              "slip: it turns less than commanded")
          .number("turn_gain", "", law(&Law::turn_gain), kPositive,
                  "share of the steering angle turned in one cycle; 1 = eq. 6, less for "
                  "vehicles with inertia")
          .number("goal_tolerance_m", "m", law(&Law::goal_tolerance_m), kPositive,
                  "distance before the last waypoint at which the mission ends (or the distance of "
                  "one cycle)")
          .number("stop_mps2", "m/s2", &P::stop_mps2, kPositive,
                  "braking before sharp corners and before the end of a movement authority; the "
                  "paper's law has neither")
          .include(&P::watch, path_watch_table())
          .boolean("aim_at_goal", law(&Law::aim_at_goal),
                   "aim at the last waypoint once it is within lookahead_m; false = as in the "
                   "paper, which may never arrive");
  return table;
}

PursuitParams read_params(const ParameterSet& parameters, const ControllerContext& context) {
  PursuitParams params = pursuit_table().read(parameters, context.part + " (pure_pursuit)");
  VINEROW_DEMAND(context.vehicle_description != nullptr);
  const std::optional<WheeledVehicle>& wheeled = context.vehicle_description->wheeled;
  const bool slips = wheeled && wheeled->effective_track_m > wheeled->track_m;
  const double radius_m = params.min_turning_radius_m.value_or(slips ? 0.0 : 1.0);
  params.law.crossed_distance_m = params.crossed_distance_m.value_or(params.law.lookahead_m);
  params.law.yaw_rate_limit_radps =
      radius_m > 0.0 ? params.law.speed_mps / radius_m : std::numeric_limits<double>::infinity();
  params.law.brake_mps2 = params.stop_mps2;
  params.law.cycle_s = context.period.s();
  return params;
}

/// The law at the speed that the wheels reach; its smallest radius stays.
PurePursuitParams slow_down(PurePursuitParams law, double reachable_mps) {
  law.yaw_rate_limit_radps *= reachable_mps / law.speed_mps;
  law.speed_mps = reachable_mps;
  return law;
}

class PurePursuit final : public Controller, public MayFail {
 public:
  PurePursuit(const PursuitParams& params, const ControllerContext& context)
      : ports_(context, "pure_pursuit"),
        wanted_mps_(params.law.speed_mps),
        speed_mps_(ports_.reachable_mps(wanted_mps_)),
        law_(slow_down(params.law, speed_mps_)),
        stop_(params.stop_mps2),
        watch_(params.watch),
        period_s_(context.period.s()) {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (ports_.has_new_plan()) take_plan(now);
    VelocityCommand command;
    FollowerState state;
    if (law_.has_path() && ports_.has_estimate() && !watch_.is_lost() && fault_.empty()) {
      const Pose2 pose = ports_.pose();
      command = law_.step(pose);
      state = describe(pose);
      command = limit(command, state);
      if (!law_.finished()) watch(pose, command.v_mps);
    }
    ports_.write(now, command, state);
  }

  bool finished() const override { return law_.finished(); }
  std::string_view failure() const override {
    return fault_.empty() ? watch_.failure() : std::string_view(fault_);
  }

 private:
  void take_plan(Time now) {
    ports_.report_slower_speed(now, wanted_mps_);
    law_.set_path(ports_.plan());
    stop_.reset();
    watch_.reset();
    fault_ = ports_.find_fault_in_plan();
    if (law_.has_path()) polyline_ = Polyline(law_.points());
  }

  /// Limits the command to the movement authority.
  VelocityCommand limit(VelocityCommand command, const FollowerState& state) {
    stop_.set_place(ports_.stop_at_m());
    command.v_mps = std::min(command.v_mps, stop_.update(state.distance_m));
    if (stop_.is_holding()) command.yaw_rate_radps = 0.0;
    return command;
  }

  Polyline::Nearest nearest_to(const Pose2& pose) const {
    constexpr int kBehind = 8, kAhead = 2;
    return polyline_.nearest_within(
        pose.p, std::max(law_.index() - kBehind, law_.stretch_first()),
        std::min(law_.index() + kAhead, std::max(law_.stretch_last() - 1, 0)));
  }

  double distance_of(const Polyline::Nearest& nearest) const {
    if (law_.points().size() < 2) return 0.0;
    const double length_m =
        (polyline_.points()[nearest.segment + 1] - polyline_.points()[nearest.segment]).norm();
    return law_.distance_m(nearest.segment) + nearest.fraction * length_m;
  }

  /// Errors from the polyline near the current index; the law itself does not use them.
  FollowerState describe(const Pose2& pose) const {
    const auto nearest = nearest_to(pose);
    const Eigen::Vector2d along =
        polyline_.points()[nearest.segment + 1] - polyline_.points()[nearest.segment];
    FollowerState state;
    state.lateral_error_m = nearest.signed_distance_m;
    state.heading_error_rad = wrap_angle(pose.yaw_rad - std::atan2(along.y(), along.x()));
    state.distance_m = distance_of(nearest);
    state.remaining_m = law_.length_m() - state.distance_m;
    state.waypoint = law_.index();
    state.finished = law_.finished();
    return state;
  }

  void watch(const Pose2& pose, double speed_mps) {
    const auto nearest = nearest_to(pose);
    watch_.update(
        {pose.p, nearest.point, distance_of(nearest), law_.length_m(), speed_mps * period_s_});
  }

  DrivePorts ports_;
  double wanted_mps_;  ///< on straights
  double speed_mps_;   ///< the same as far as the wheels reach it
  PurePursuitLaw law_;
  StopProfile stop_;
  PathWatch watch_;
  std::string fault_;  ///< of the plan
  double period_s_;
  Polyline polyline_;
};

}  // namespace

PartSpec pure_pursuit_spec() {
  PartSpec spec;
  spec.name = "pure_pursuit";
  spec.description =
      "Lookahead follower of Martelli, Mocera, Soma 2024 (eq. 1-7): local goal point on the "
      "lookahead circle, current index, steering threshold; wheel speeds of a speed-steered "
      "vehicle.";
  pursuit_table().add_to(spec);
  spec.default_rate_Hz = 40.0;
  spec.reads = {"estimate", "plan", "authority"};
  spec.writes = {"actuators", "command", "follower", "controller_event"};
  return spec;
}

std::unique_ptr<Controller> make_pure_pursuit(const ParameterSet& parameters,
                                              const ControllerContext& context) {
  return std::make_unique<PurePursuit>(read_params(parameters, context), context);
}

}  // namespace vinerow::controllers
