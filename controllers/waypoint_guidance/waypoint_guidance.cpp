#include "controllers/waypoint_guidance/waypoint_guidance.h"

#include <fmt/format.h>

#include <algorithm>

#include "controllers/parts/aircraft/wind_estimate.h"
#include "controllers/parts/aircraft/wind_triangle.h"
#include "controllers/waypoint_guidance/air_mission.h"
#include "controllers/waypoint_guidance/waypoint_guidance_params.h"
#include "engine/api/may_fail.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/scene_query.h"
#include "engine/api/sees_ground.h"

namespace vinerow::controllers {
namespace {

bool is_finite(const Odometry& odometry) {
  return odometry.X_WB.p.allFinite() && odometry.X_WB.q.coeffs().allFinite() &&
         odometry.v_WB_B.allFinite() && odometry.w_WB_B.allFinite();
}

class WaypointGuidance final : public Guidance, public MayFail, public SeesGround {
 public:
  WaypointGuidance(const ParameterSet& parameters, const ControllerContext& context)
      : source_(context.part),
        period_s_(context.period.s()),
        params_(read_waypoint_guidance_params(parameters, context)),
        wind_(params_.wind_s),
        mission_(params_) {
    reference_.airspeed_mps = params_.legs.airspeed_mps;
    warnings_ = params_.old_key;
    landing_.names = {"x_m", "y_m"};
    landing_.values.assign(2, 0.0);
  }

  void connect(Ports& ports) override {
    estimate_ = ports.read<Odometry>("estimate");
    plan_ = ports.read<PlannedPath>("plan");
    if (!params_.air_data.empty()) air_ = ports.read<AirData>(params_.air_data);
    out_ = ports.write<AirReference>("reference");
    event_writer_ = ports.write<Event>("guidance_event");
    landing_out_ = ports.write<NamedValues>("landing");
  }

  void step(Time now) override {
    const double dt_s = has_stepped_ ? (now - last_).s() : period_s_;
    has_stepped_ = true;
    last_ = now;
    // An estimate that is not finite is ignored: the reference stays as it is.
    if (estimate_.has_value() && is_finite(estimate_.value())) {
      take_state(dt_s);
      if (!mission_.has_plan()) take_plan(now);
      fly(now, dt_s);
      fill_reference();
    }
    out_.write(now, reference_);
  }

  std::string_view failure() const override { return mission_.failure(); }

  void see_ground(const SceneQuery& ground) override {
    constexpr double kAboveEverything_m = 1e6;
    mission_.see_ground([&ground](const Eigen::Vector2d& p) {
      return ground.ground_height_m(p.x(), p.y(), kAboveEverything_m);
    });
  }

 private:
  void take_state(double dt_s) {
    const Odometry& estimate = estimate_.value();
    if (air_.has_value()) wind_.add(estimate, air_.value(), dt_s);
    const Eigen::Vector3d v_W = estimate.X_WB.q * estimate.v_WB_B;
    const RollPitchYaw rpy = rpy_from_quaternion(estimate.X_WB.q);
    state_.position = estimate.X_WB.p.head<2>();
    state_.height_m = estimate.X_WB.p.z();
    state_.velocity = v_W.head<2>();
    state_.climb_mps = v_W.z();
    state_.yaw_rad = rpy.yaw_rad;
    state_.bank_left_rad = -rpy.roll_rad;
    state_.wind = wind_.wind_W();
  }

  /// Allocates.
  void take_plan(Time now) {
    if (!plan_.is_newer_than(seen_plan_)) return;
    Result<FlightLegs> plan = make_flight_legs(plan_.value(), params_.legs);
    if (!plan) {
      report_event(now, Event::Level::kWarning, plan.reason() + ": waits for another");
      return;
    }
    for (const std::string& warning : plan->warnings) {
      warnings_ += (warnings_.empty() ? "" : "; ") + warning;
    }
    mission_.take_plan(std::move(plan).value(), state_);
  }

  void fly(Time now, double dt_s) {
    if (!mission_.has_plan()) return;
    const bool waits =
        !mission_.has_begun() && now.s() < params_.start_s && !mission_.is_flying(state_);
    if (mission_.has_begun()) {
      mission_.advance(dt_s, state_);
    } else if (!waits) {
      mission_.begin(state_);
    }
    report_events(now);
    write_landing(now);
  }

  void write_landing(Time now) {
    const auto place = mission_.touchdown();
    if (has_written_landing_ || !place) return;
    has_written_landing_ = true;
    landing_.values = {place->x(), place->y()};
    landing_out_.write(now, landing_);
  }

  /// At most one event per tick: a signal holds the last event written.
  void report_events(Time now) {
    const std::string& event_text = mission_.event_text();
    if (event_text.empty() && warnings_.empty()) return;
    const bool is_bad = !warnings_.empty() || mission_.is_warning();
    report_event(now, is_bad ? Event::Level::kWarning : Event::Level::kInfo,
                 event_text + (event_text.empty() || warnings_.empty() ? "" : "; ") + warnings_);
    warnings_.clear();
  }

  void fill_reference() {
    reference_.phase = mission_.phase();
    reference_.power = mission_.has_power();
    reference_.wind_W = {state_.wind.x(), state_.wind.y(), 0.0};
    if (!mission_.has_begun()) {
      reference_.remaining_m = mission_.length_m();
      reference_.heading_rad = reference_.course_rad = state_.yaw_rad;
      reference_.height_m = state_.height_m;
      return;
    }
    const HeadingGenerator& heading = mission_.heading();
    const double airspeed_mps = mission_.airspeed_mps();
    const Eigen::Vector2d v_W =
        calc_ground_velocity(heading.heading_rad(), state_.wind, airspeed_mps);
    reference_.airspeed_mps = airspeed_mps;
    reference_.course_rad = std::atan2(v_W.y(), v_W.x());
    reference_.heading_rad = heading.heading_rad();
    reference_.heading_rate_radps = heading.rate_radps();
    reference_.bank_rad = -heading.bank_left_rad();
    reference_.height_m = mission_.height().height_m();
    reference_.climb_angle_rad = mission_.height().climb_rad(airspeed_mps);
    reference_.cross_track_m = mission_.cross_track_m(state_);
    reference_.waypoint = mission_.waypoint();
    reference_.distance_m = mission_.distance_m(state_);
    reference_.remaining_m = std::max(0.0, mission_.length_m() - reference_.distance_m);
  }

  /// Allocates.
  void report_event(Time now, Event::Level level, std::string text) {
    event_writer_.write(now, {level, source_, std::move(text)});
  }

  std::string source_;
  double period_s_;
  WaypointGuidanceParams params_;
  WindEstimate wind_;
  AirMission mission_;
  GuidanceState state_;
  AirReference reference_;
  std::string warnings_;  // of the plan, not yet reported
  bool has_stepped_ = false;
  Time last_;
  std::uint64_t seen_plan_ = 0;
  SignalReader<Odometry> estimate_;
  SignalReader<PlannedPath> plan_;
  SignalReader<AirData> air_;
  SignalWriter<AirReference> out_;
  SignalWriter<Event> event_writer_;
  SignalWriter<NamedValues> landing_out_;  ///< planned touchdown, once
  NamedValues landing_;
  bool has_written_landing_ = false;
};

}  // namespace

PartSpec waypoint_guidance_spec() {
  PartSpec spec;
  spec.name = "waypoint_guidance";
  spec.description =
      "Reference of a fixed-wing vehicle, from the launcher along the plan's waypoints to the "
      "ground: heading by cross track and turn, height by ramps, in wind (paper A, eq. 1-7).";
  add_waypoint_guidance_parameters(spec);
  spec.default_rate_Hz = 20.0;
  spec.reads = {"estimate", "plan", "<air_data>"};
  spec.writes = {"reference", "guidance_event", "landing"};
  return spec;
}

std::unique_ptr<Guidance> make_waypoint_guidance(const ParameterSet& parameters,
                                                 const ControllerContext& context) {
  return std::make_unique<WaypointGuidance>(parameters, context);
}

}  // namespace vinerow::controllers
