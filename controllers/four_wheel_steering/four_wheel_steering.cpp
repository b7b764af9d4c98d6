#include "controllers/four_wheel_steering/four_wheel_steering.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/four_wheel_steering/drive_profile.h"
#include "controllers/four_wheel_steering/four_wheel_params.h"
#include "controllers/four_wheel_steering/path_reference.h"
#include "controllers/four_wheel_steering/slip_learning.h"
#include "controllers/four_wheel_steering/steered_vehicle.h"
#include "controllers/four_wheel_steering/steering_law.h"
#include "controllers/four_wheel_steering/wheel_speeds.h"
#include "controllers/parts/ground_drive/plan_speed.h"
#include "controllers/parts/ground_drive/stop_profile.h"
#include "controllers/parts/paths/path_watch.h"
#include "engine/api/may_fail.h"
#include "engine/api/messages/event.h"
#include "engine/api/parameter_table.h"
#include "engine/core/check.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

std::string describe(const ControllerContext& context) {
  VINEROW_DEMAND(context.vehicle_description != nullptr);
  const std::string who = fmt::format("{} (four_wheel_steering)", context.part);
  if (context.period.ns <= 0) throw ConfigError(fmt::format("{}: rate_Hz must be > 0", who));
  return who;
}

/// Motion to drive in this cycle.
struct Drive {
  AxleAngles axles;
  double speed_mps = 0.0;
};

class FourWheelSteering final : public Controller, public MayFail {
 public:
  FourWheelSteering(const ParameterSet& parameters, const ControllerContext& context)
      : part_(context.part),
        vehicle_(read_steered_vehicle(*context.vehicle_description, describe(context))),
        params_(
            read_four_wheel_params(parameters, vehicle_, context.period.s(), describe(context))),
        tracker_(params_.reference),
        axles_(vehicle_),
        slip_(params_.slip_learn_s),
        stop_(params_.drive.acceleration_mps2),
        watch_(params_.watch),
        wheels_(params_.wheels),
        actuator_values_(make_steered_actuators()) {
    steering_values_.names = {"front_des_rad", "rear_des_rad",     "front_act_rad",
                              "rear_act_rad",  "v_des_mps",        "curvature_per_m",
                              "side_slip_rad", "qp_cost",          "qp_iterations",
                              "qp_status",     "slip_residual_mps"};
    steering_values_.values.assign(steering_values_.names.size(), 0.0);
  }

  void connect(Ports& ports) override {
    estimate_ = ports.read<Odometry>("estimate");
    plan_ = ports.read<PlannedPath>("plan");
    local_ = ports.read_optional<LocalCommand>("local_command");
    encoders_ = ports.read_optional<NamedValues>("encoders");
    authority_ = ports.read_optional<MovementAuthority>("authority");
    actuators_ = ports.write<NamedValues>("actuators");
    command_ = ports.write<VelocityCommand>("command");
    follower_ = ports.write<FollowerState>("follower");
    steering_ = ports.write<NamedValues>("steering");
    event_ = ports.write<Event>("controller_event");
  }

  void step(Time now) override {
    if (plan_.is_newer_than(seen_plan_)) take_plan(now);
    axles_.advance(params_.cycle_s);
    if (encoders_.has_value()) axles_.measure(encoders_.value());

    const Drive drive = decide();
    if (!wheels_.has_failed()) {
      axles_.command(drive.axles);
      ramp_speed(drive.speed_mps);
    }
    // The axles turn while the wheels run: the angles in the middle of the cycle count.
    const Rolling rolling = calc_rolling(vehicle_.geometry, axles_.predict(0.5 * params_.cycle_s));
    speed_mps_ = limit_speed(rolling, speed_mps_, vehicle_.rim_max_mps);
    const bool had_failed = wheels_.has_failed();
    wheels_.update(rolling, speed_mps_);
    if (wheels_.has_failed() && !had_failed) report_failure(now);
    if (wheels_.has_failed()) speed_mps_ = 0.0;
    write(now, rolling);
  }

  bool finished() const override {
    return state_.finished && !wheels_.has_failed() && wheels_.rim_mps().isZero(0.0);
  }
  std::string_view failure() const override { return watch_.failure(); }

 private:
  void take_plan(Time now) {
    for (const std::string& text :
         describe_slower_speeds(plan_.value(), params_.drive.speed_mps, vehicle_.rim_max_mps)) {
      event_.write(now, {Event::Level::kWarning, part_, text});
    }
    tracker_.set_path(plan_.value());
    state_ = {};
    stop_.reset();
    watch_.reset();
    state_.finished = tracker_.path().empty();
    state_.remaining_m = tracker_.path().length_m();
    if (!tracker_.path().empty()) profile_ = DriveProfile(tracker_.path(), params_.drive);
  }

  bool can_follow() const {
    return estimate_.has_value() && !tracker_.path().empty() && !state_.finished &&
           !watch_.is_lost();
  }

  /// At rest the axles keep their angles: turning them on the spot wears the tyres.
  Drive decide() {
    Drive drive{axles_.wanted(), 0.0};
    if (estimate_.has_value()) learn();
    max_mps_ = std::numeric_limits<double>::infinity();
    if (can_follow()) drive = follow();
    if (local_.has_value() && !state_.finished && !watch_.is_lost()) {
      drive = obey(local_.value(), drive);
    }
    drive.speed_mps = std::min(drive.speed_mps, max_mps_);
    if (stop_.is_holding() && drive.speed_mps == 0.0) drive.axles = axles_.wanted();
    return drive;
  }

  /// Applies the local planner's command to the motion along the plan.
  Drive obey(const LocalCommand& local, Drive drive) const {
    switch (local.mode) {
      case LocalCommand::Mode::kFollow:
        drive.speed_mps = std::min(drive.speed_mps, std::max(local.v_mps, 0.0));
        break;
      case LocalCommand::Mode::kDrive:
        drive = {{cut(local.front_axle_rad), cut(local.rear_axle_rad)}, local.v_mps};
        break;
      case LocalCommand::Mode::kStop:
        drive = {axles_.wanted(), 0.0};
        break;
    }
    return drive;
  }

  double cut(double angle_rad) const {
    return std::clamp(angle_rad, -vehicle_.max_axle_steer_rad, vehicle_.max_axle_steer_rad);
  }

  void learn() {
    const Odometry& estimate = estimate_.value();
    slip_.update(calc_rolling(vehicle_.geometry, axles_.actual()), estimate.v_WB_B.head<2>(),
                 estimate.w_WB_B.z(), params_.cycle_s);
  }

  Drive follow() {
    const Pose& X_WB = estimate_.value().X_WB;
    const PathReference reference =
        tracker_.update({X_WB.p.head<2>(), yaw_from_quaternion(X_WB.q)}, speed_mps_);
    const Path& path = tracker_.path();
    state_.lateral_error_m = reference.at.lateral_error_m;
    state_.heading_error_rad = reference.heading_error_rad;
    state_.distance_m = reference.at.distance_m;
    state_.remaining_m = path.length_m() - reference.at.distance_m;
    state_.waypoint = reference.at.segment;
    state_.finished = state_.remaining_m < params_.goal_tolerance_m;
    // A local planner that drives by itself may take any distance.
    const bool is_driven = local_.has_value() && local_.value().mode == LocalCommand::Mode::kDrive;
    watch_.update({X_WB.p.head<2>(), path.pose_at(state_.distance_m, state_.waypoint).p,
                   state_.distance_m, path.length_m(),
                   is_driven ? 0.0 : std::max(speed_mps_, 0.0) * params_.cycle_s, state_.finished});
    if (watch_.is_lost()) {
      state_.finished = false;
      return {axles_.wanted(), 0.0};
    }
    stop_.set_place(read_stop_at_m(authority_));
    max_mps_ = stop_.update(state_.distance_m);
    if (state_.finished) return {axles_.wanted(), 0.0};

    SteeringInput input;
    input.lateral_error_m = state_.lateral_error_m;
    input.heading_error_rad = state_.heading_error_rad;
    if (params_.feed_forward) {
      input.heading_error_rad = reference.smooth_heading_error_rad;
      input.reference_per_m =
          reference.curvature_per_m * calc_slope_factor(X_WB.q, reference.at.yaw_rad);
    }
    input.slip_rad = slip_.slip_rad();
    input.slip_curvature_per_m = slip_.curvature_per_m();
    const SteeringCommand command = steer(vehicle_.geometry, params_.steering, input);
    // Turn before driving off in a wrong direction.
    const double towards = std::max(std::cos(state_.heading_error_rad), 0.1);
    return {command.axles,
            towards * profile_.speed_at(path, reference.at.segment, reference.at.distance_m)};
  }

  /// Accelerates with the given acceleration and brakes twice as hard, through zero if necessary.
  void ramp_speed(double wanted_mps) {
    const double step = params_.drive.acceleration_mps2 * params_.cycle_s;
    if (state_.finished) {
      speed_mps_ = 0.0;  // the profile has led there at a crawl
      return;
    }
    const double sign = speed_mps_ < 0.0 || (speed_mps_ == 0.0 && wanted_mps < 0.0) ? -1.0 : 1.0;
    const double now = sign * speed_mps_, wanted = sign * wanted_mps;
    speed_mps_ = sign * std::clamp(wanted, std::max(now - 2.0 * step, 0.0), now + step);
  }

  void report_failure(Time now) {
    const Eigen::Vector4d& rim = wheels_.rim_mps();
    event_.write(
        now, {Event::Level::kError, part_,
              fmt::format("no wheel speeds for {:.3f} m/s at axle angles {:.4f} and {:.4f} rad "
                          "(velocity QP: {}, slip tolerance {:g} m/s, rim speeds {:.3f} {:.3f} "
                          "{:.3f} {:.3f} m/s): stops and stays stopped",
                          speed_mps_, axles_.actual().front_rad, axles_.actual().rear_rad,
                          to_string(wheels_.status()), params_.wheels.qp.slip_mps, rim[0], rim[1],
                          rim[2], rim[3])});
  }

  void write(Time now, const Rolling& rolling) {
    const Eigen::Vector4d& rim = wheels_.rim_mps();
    actuator_values_.values[0] = axles_.wanted().front_rad;
    actuator_values_.values[1] = axles_.wanted().rear_rad;
    for (int i = 0; i < kWheels; ++i) {
      actuator_values_.values[2 + i] = rim[i] / vehicle_.geometry.wheel_radius_m;
    }
    actuators_.write(now, actuator_values_);
    const double forward_mps = rim.cwiseQuotient(rolling.reach).mean();
    command_.write(now, {forward_mps, forward_mps * rolling.curvature_per_m});
    follower_.write(now, state_);
    steering_values_.values.assign({axles_.wanted().front_rad, axles_.wanted().rear_rad,
                                    axles_.actual().front_rad, axles_.actual().rear_rad, speed_mps_,
                                    rolling.track_curvature_per_m(), slip_.slip_rad(),
                                    wheels_.cost(), static_cast<double>(wheels_.iterations()),
                                    static_cast<double>(wheels_.status()), wheels_.slip_mps()});
    steering_.write(now, steering_values_);
  }

  std::string part_;
  SteeredDrive vehicle_;
  FourWheelParams params_;
  PathTracker tracker_;
  DriveProfile profile_;
  AxleState axles_;
  SlipLearning slip_;
  StopProfile stop_;
  PathWatch watch_;
  WheelSpeeds wheels_;
  FollowerState state_;
  double speed_mps_ = 0.0;                                    ///< commanded, of B's origin
  double max_mps_ = std::numeric_limits<double>::infinity();  ///< that the authority allows
  NamedValues actuator_values_, steering_values_;
  std::uint64_t seen_plan_ = 0;
  SignalReader<Odometry> estimate_;
  SignalReader<PlannedPath> plan_;
  SignalReader<LocalCommand> local_;
  SignalReader<NamedValues> encoders_;
  SignalReader<MovementAuthority> authority_;
  SignalWriter<NamedValues> actuators_, steering_;
  SignalWriter<VelocityCommand> command_;
  SignalWriter<FollowerState> follower_;
  SignalWriter<Event> event_;
};

}  // namespace

PartSpec four_wheel_steering_spec() {
  PartSpec spec;
  spec.name = "four_wheel_steering";
  spec.description =
      "Follows a path with two steered axles and four driven wheels: proportional steering of "
      "Mammarella et al. 2022 (eq. 24-26, corrected or as printed) and wheel speeds by the "
      "velocity QP (eq. 30-33); obeys a local planner if there is one.";
  four_wheel_table().add_to(spec);
  spec.default_rate_Hz = 50.0;
  spec.reads = {"estimate", "plan", "local_command", "encoders", "authority"};
  spec.writes = {"actuators", "command", "follower", "steering", "controller_event"};
  return spec;
}

std::unique_ptr<Controller> make_four_wheel_steering(const ParameterSet& parameters,
                                                     const ControllerContext& context) {
  return std::make_unique<FourWheelSteering>(parameters, context);
}

}  // namespace vinerow::controllers
