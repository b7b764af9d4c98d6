#include "controllers/quadrotor_mpc/quadrotor_mpc.h"

#include <fmt/format.h>

#include <algorithm>

#include "controllers/parts/rotorcraft/flight_ports.h"
#include "controllers/quadrotor_mpc/limit_watch.h"
#include "controllers/quadrotor_mpc/quadrotor_mpc_law.h"
#include "engine/api/messages/event.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

constexpr const char* kType = "quadrotor_mpc";

std::string describe(const ControllerContext& context) {
  return fmt::format("{} ({})", context.part, kType);
}

QuadrotorMpcParams read_params(const ParameterSet& parameters, const ControllerContext& context) {
  QuadrotorMpcParams params = quadrotor_mpc_table().read(parameters, describe(context));
  const Rotorcraft& craft = context.vehicle_description->need_rotorcraft(describe(context));
  params.limits.tilt_rad = std::min(params.limits.tilt_rad, craft.max_tilt_rad);
  params.period_s = context.period.s();
  return params;
}

class QuadrotorMpc final : public Controller {
 public:
  QuadrotorMpc(const ParameterSet& parameters, const ControllerContext& context)
      : part_(context.part),
        period_(context.period),
        ports_(context, kType),
        params_(read_params(parameters, context)),
        law_(ports_.craft(), params_, describe(context)),
        watch_(params_.limits) {
    preview_.resize(static_cast<std::size_t>(params_.horizon) + 1);
    mpc_values_.names = {"roll_rad",         "pitch_rad",        "tilt_rad",
                         "lateral_m",        "altitude_m",       "speed_error_mps",
                         "soft_violation",   "disturbance_x_N",  "disturbance_y_N",
                         "disturbance_z_N",  "disturbance_x_Nm", "disturbance_y_Nm",
                         "disturbance_z_Nm", "qp_iterations",    "qp_status"};
    mpc_values_.values.assign(mpc_values_.names.size(), 0.0);
  }

  void connect(Ports& ports) override {
    ports_.connect(ports);
    reference_ = ports.read<ReferenceTrajectory>("reference");
    mpc_out_ = ports.write<NamedValues>("mpc");
    event_ = ports.write<Event>("controller_event");
  }

  void step(Time now) override {
    if (!ports_.is_flying()) {
      ports_.write_off(now);
      was_flying_ = false;
      return;
    }
    if (!was_flying_) start();
    look_ahead(now);
    const Wrench& wanted = law_.step(ports_.estimate(), preview_, ports_.has_lifted_off());
    ports_.write(now, wanted);
    // On the ground the limits of the flight do not apply.
    if (!ports_.is_done()) report(now);
    write(now);
  }

  bool finished() const override { return ports_.has_ended(); }

 private:
  /// A flight that does not start with a take-off starts in the air.
  void start() {
    was_flying_ = true;
    watch_.reset();
    has_failed_ = false;
    ports_.reference().phase == ReferenceTrajectory::Phase::kTakeOff ? law_.reset()
                                                                     : law_.reset_hovering();
  }

  /// The reference at the controller's own ticks. Past its end, which a late reference or a longer
  /// horizon reaches, it continues with its last motion; one at rest holds its place.
  void look_ahead(Time now) {
    const ReferenceTrajectory& reference = ports_.reference();
    const Time end =
        reference_.stamp() +
        duration_from_s(reference.dt_s * static_cast<double>(reference.points.size() - 1));
    Time at = now;
    for (TrajectoryPoint& point : preview_) {
      if (at <= end || now > end) {
        point = ports_.reference_at(at);
      } else {
        const double beyond_s = (at - end).s();
        point = reference.points.back();
        point.p_W += beyond_s * point.v_W;
        point.yaw_rad += beyond_s * point.yaw_rate_radps;
        point.a_W.setZero();
      }
      at = at + period_;
    }
  }

  FlightDeviation deviation() const {
    const HoverState& state = law_.state();
    double altitude_m = state.x[kHoverPosition + 2];
    // A landing reference sinks on until the touchdown is detected.
    if (ports_.reference().phase == ReferenceTrajectory::Phase::kLand) {
      altitude_m = std::min(altitude_m, 0.0);
    }
    return {state.tilt_rad(), state.x[kHoverPosition + 1], altitude_m, law_.speed_error_mps()};
  }

  /// At most one event per tick; a failure of the solver comes first.
  void report(Time now) {
    const bool fails = law_.status() != QpStatus::kSolved;
    if (fails != has_failed_) {
      has_failed_ = fails;
      if (fails) {
        report_event(now, Event::Level::kError,
                     fmt::format("no optimal inputs (QP: {}): the last valid ones are used",
                                 to_string(law_.status())));
      } else {
        report_event(now, Event::Level::kInfo, "optimal inputs again");
      }
      return;
    }
    if (!ports_.has_lifted_off()) return;  // the ground determines the state
    const FlightDeviation off = deviation();
    switch (watch_.update(off, now.s())) {
      case LimitWatch::PendingEvent::kNone:
        break;
      case LimitWatch::PendingEvent::kLeft:
        report_event(now, Event::Level::kWarning,
                     fmt::format("state outside its bounds: {}; soft constraints take over",
                                 watch_.describe(off)));
        break;
      case LimitWatch::PendingEvent::kBack:
        report_event(
            now, Event::Level::kInfo,
            fmt::format("state back inside its bounds after {:.2f} s", watch_.outside_s()));
        break;
    }
  }

  void report_event(Time now, Event::Level level, const std::string& text) {
    event_.write(now, {level, part_, text});
  }

  void write(Time now) {
    const HoverState& state = law_.state();
    const RotorcraftModel& craft = ports_.craft();
    const Eigen::Vector3d force = craft.mass_kg * law_.disturbance().acceleration_W();
    const Eigen::Vector3d torque = craft.inertia_kgm2.cwiseProduct(law_.disturbance().angular_B());
    mpc_values_.values.assign({state.x[kHoverAngle], state.x[kHoverAngle + 1], state.tilt_rad(),
                               state.x[kHoverPosition + 1], state.x[kHoverPosition + 2],
                               law_.speed_error_mps(), law_.mpc().soft_violation(), force.x(),
                               force.y(), force.z(), torque.x(), torque.y(), torque.z(),
                               static_cast<double>(law_.mpc().iterations()),
                               static_cast<double>(law_.status())});
    mpc_out_.write(now, mpc_values_);
  }

  std::string part_;
  Duration period_;
  FlightPorts ports_;
  QuadrotorMpcParams params_;
  QuadrotorMpcLaw law_;
  LimitWatch watch_;
  bool was_flying_ = false, has_failed_ = false;
  std::vector<TrajectoryPoint> preview_;
  NamedValues mpc_values_;
  SignalReader<ReferenceTrajectory> reference_;
  SignalWriter<NamedValues> mpc_out_;
  SignalWriter<Event> event_;
};

}  // namespace

PartSpec quadrotor_mpc_spec() {
  PartSpec spec;
  spec.name = kType;
  spec.description =
      "Flies a rotorcraft along a reference by linear model predictive control (Mammarella et al. "
      "2022, section 4.2): 16 states about hover in the frame of the wanted heading, limits of "
      "thrust, torques and tilt, soft limits of the deviation, and a disturbance observer.";
  quadrotor_mpc_table().add_to(spec);
  spec.default_rate_Hz = 20.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "wrench", "follower", "mpc", "controller_event"};
  return spec;
}

std::unique_ptr<Controller> make_quadrotor_mpc(const ParameterSet& parameters,
                                               const ControllerContext& context) {
  return std::make_unique<QuadrotorMpc>(parameters, context);
}

}  // namespace vinerow::controllers
