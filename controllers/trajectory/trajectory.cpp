#include "controllers/trajectory/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/ground_drive/plan_speed.h"
#include "controllers/parts/ground_drive/stop_profile.h"
#include "controllers/trajectory/flight_clock.h"
#include "controllers/trajectory/simple_flights.h"
#include "controllers/trajectory/trajectory_params.h"
#include "engine/api/messages/event.h"
#include "engine/api/parameter_table.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Phase = ReferenceTrajectory::Phase;

class Trajectory final : public Guidance {
 public:
  Trajectory(const ParameterSet& parameters, const ControllerContext& context)
      : source_(context.part),
        params_(read_trajectory_params(parameters, context)),
        watch_(params_.landing) {
    reference_.dt_s = params_.sample_s;
    reference_.points.resize(params_.horizon + 1);
  }

  void connect(Ports& ports) override {
    estimate_ = ports.read<Odometry>("estimate");
    plan_ = params_.hover_m ? ports.read_optional<PlannedPath>("plan")
                            : ports.read<PlannedPath>("plan");
    authority_ = ports.read_optional<MovementAuthority>("authority");
    out_ = ports.write<ReferenceTrajectory>("reference");
    event_writer_ = ports.write<Event>("guidance_event");
  }

  void step(Time now) override {
    const double dt_s = (now - last_).s();
    last_ = now;
    if (flight_.empty()) {
      take_flight(now);
      take_authority();
      clock_.start();
    } else if (!has_landed_) {
      take_authority();
      advance(now, dt_s);
    }
    if (params_.hover_m && !ignores_plan_ && plan_.has_value()) {
      ignores_plan_ = true;
      report_event(now, Event::Level::kWarning, "ignores the plan, since hover_m is given");
    }
    write(now);
  }

 private:
  /// Computes the flight once all its data are present. Allocates.
  void take_flight(Time now) {
    if (!estimate_.has_value()) return;
    const Pose& X_WB = estimate_.value().X_WB;
    const double yaw_rad = yaw_from_quaternion(X_WB.q);
    if (params_.hover_m) {
      Eigen::Vector3d place = *params_.hover_m;
      place.z() += X_WB.p.z() - params_.rest_height_m;
      flight_ = FlightTrajectory(make_hover_plan(X_WB.p, place), yaw_rad, params_.flight);
    } else if (plan_.is_newer_than(seen_plan_) && plan_.value().points.size() > 1) {
      const PlannedPath& plan = plan_.value();
      flight_ = FlightTrajectory(
          has_vertical(plan) ? plan
                             : lift_plan(plan, X_WB.p, params_.height_m, params_.rest_height_m),
          yaw_rad, params_.flight);
    }
    if (flight_.empty()) return;
    const std::string warning = params_.hover_m ? "" : describe_plan();
    report_event(now, warning.empty() ? Event::Level::kInfo : Event::Level::kWarning,
                 fmt::format("takes off for {:.1f} m{}{}", flight_.length_m(),
                             std::isfinite(flight_.duration_s())
                                 ? fmt::format(" in {:.1f} s", flight_.duration_s())
                                 : "",
                             warning));
  }

  /// What a plan wants that the flight does not give; empty: nothing.
  std::string describe_plan() const {
    const TrajectoryLimits& limits = params_.flight.limits;
    std::string text;
    for (const std::string& too_fast :
         {describe_too_fast_plan(plan_.value(), limits.transit_speed_mps, "transit_speed_mps",
                                 [](PathKind kind) { return kind == PathKind::kTransit; }),
          describe_too_fast_plan(
              plan_.value(), limits.row_speed_mps, "row_speed_mps",
              [](PathKind kind) { return kind == PathKind::kLeg || kind == PathKind::kTurn; }),
          describe_too_fast_plan(plan_.value(), limits.return_speed_mps, "return_speed_mps",
                                 [](PathKind kind) { return kind == PathKind::kReturn; })}) {
      if (!too_fast.empty()) text += "; " + too_fast;
    }
    if (flight_.at(flight_.duration_s()).phase != Phase::kLand) {
      text += "; its plan has no landing: it hovers at the end and does not finish";
    }
    return text;
  }

  /// Place at which the flight waits until it may continue.
  void take_authority() {
    const double stop_at_m = read_stop_at_m(authority_);
    if (flight_.empty() || stop_at_m == stop_at_m_) return;
    stop_at_m_ = stop_at_m;
    const bool is_beyond = stop_at_m >= flight_.length_m();
    clock_.set_stop(is_beyond ? std::numeric_limits<double>::infinity()
                              : flight_.time_of(stop_at_m - StopProfile::kShort_m));
  }

  void advance(Time now, double dt_s) {
    clock_.advance(dt_s, wanted_rate_);
    const FlightTrajectory::Sample present = flight_.at(clock_.time_s());
    const Odometry& estimate = estimate_.value();
    const bool lands = present.phase == Phase::kLand;
    const double away_m = (present.point.p_W - estimate.X_WB.p).norm();
    // During the descent the ground holds the vehicle back.
    wanted_rate_ = lands ? 1.0 : calc_clock_rate(away_m, params_.wait_m);
    describe_waiting(now, away_m, present.distance_m);
    if (!lands) return;
    LandingWatch::Observation observation;
    observation.wanted_mps = present.point.v_W.z() * clock_.rate();
    observation.vertical_mps = (estimate.X_WB.q * estimate.v_WB_B).z();
    observation.above_end_m = estimate.X_WB.p.z() - flight_.end_height_m();
    observation.is_over = clock_.time_s() >= flight_.duration_s();
    if (!watch_.has_landed(observation, dt_s)) return;
    has_landed_ = true;
    rest_.p_W = estimate.X_WB.p;
    rest_.yaw_rad = present.point.yaw_rad;
    report_event(now, Event::Level::kInfo,
                 fmt::format("landed at ({:.2f}, {:.2f}), {:.2f} m {} the end of its plan",
                             rest_.p_W.x(), rest_.p_W.y(), std::abs(observation.above_end_m),
                             observation.above_end_m < 0.0 ? "below" : "above"));
  }

  void write(Time now) {
    if (flight_.empty() && estimate_.has_value()) {
      rest_.p_W = estimate_.value().X_WB.p;
      rest_.yaw_rad = yaw_from_quaternion(estimate_.value().X_WB.q);
    }
    if (flight_.empty() || has_landed_) {
      std::fill(reference_.points.begin(), reference_.points.end(), rest_);
      reference_.phase = has_landed_ ? Phase::kDone : Phase::kWait;
      if (has_landed_) reference_.distance_m = flight_.length_m();
      reference_.remaining_m = 0.0;
      out_.write(now, reference_);
      return;
    }
    FlightClock clock = clock_;
    for (std::size_t i = 0; i < reference_.points.size(); ++i) {
      const FlightTrajectory::Sample sample = flight_.at(clock.time_s());
      TrajectoryPoint& point = reference_.points[i];
      point = sample.point;
      point.v_W *= clock.rate();
      point.a_W = sample.point.a_W * (clock.rate() * clock.rate()) +
                  sample.point.v_W * clock.slope_per_s(wanted_rate_);
      point.yaw_rate_radps *= clock.rate();
      if (i == 0) {
        reference_.distance_m = sample.distance_m;
        reference_.remaining_m = flight_.length_m() - sample.distance_m;
        reference_.phase = sample.phase;
      }
      clock.advance(params_.sample_s, wanted_rate_);
    }
    // A plan that does not end on the ground ends in the air.
    if (clock_.time_s() >= flight_.duration_s() && reference_.phase != Phase::kLand) {
      reference_.phase = Phase::kHover;
    }
    out_.write(now, reference_);
  }

  /// One event per wait.
  void describe_waiting(Time now, double away_m, double distance_m) {
    if (wanted_rate_ == 1.0) {
      if (away_m < 0.5 * params_.wait_m) is_waiting_ = false;
      return;
    }
    if (is_waiting_) return;
    is_waiting_ = true;
    report_event(
        now, Event::Level::kWarning,
        fmt::format("the vehicle is {:.2f} m from the reference after {:.1f} m: waits for it",
                    away_m, distance_m));
  }

  /// Allocates.
  void report_event(Time now, Event::Level level, std::string text) {
    event_writer_.write(now, {level, source_, std::move(text)});
  }

  std::string source_;
  TrajectoryParams params_;
  FlightTrajectory flight_;
  FlightClock clock_;
  double wanted_rate_ = 1.0;
  double stop_at_m_ = std::numeric_limits<double>::infinity();  ///< along the plan
  LandingWatch watch_;
  bool has_landed_ = false;
  bool is_waiting_ = false;
  bool ignores_plan_ = false;
  TrajectoryPoint rest_;  // before and after the flight
  ReferenceTrajectory reference_;
  Time last_;
  std::uint64_t seen_plan_ = 0;
  SignalReader<Odometry> estimate_;
  SignalReader<PlannedPath> plan_;
  SignalReader<MovementAuthority> authority_;
  SignalWriter<ReferenceTrajectory> out_;
  SignalWriter<Event> event_writer_;
};

}  // namespace

PartSpec trajectory_spec() {
  PartSpec spec;
  spec.name = "trajectory";
  spec.description =
      "Reference of a rotorcraft over the controller's horizon: a time law along the plan with "
      "3 m/s in rows, slow turns, climb, return and landing (paper A, 4.2).";
  trajectory_table().add_to(spec);
  spec.default_rate_Hz = 20.0;
  spec.reads = {"estimate", "plan", "authority"};
  spec.writes = {"reference", "guidance_event"};
  return spec;
}

std::unique_ptr<Guidance> make_trajectory(const ParameterSet& parameters,
                                          const ControllerContext& context) {
  return std::make_unique<Trajectory>(parameters, context);
}

}  // namespace vinerow::controllers
