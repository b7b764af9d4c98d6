#include "controllers/autopilot/ardupilot/ardupilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "controllers/autopilot/ardupilot/ardupilot_params.h"
#include "controllers/autopilot/ardupilot/recorded_lockstep.h"
#include "controllers/autopilot/ardupilot/running_lockstep.h"
#include "controllers/autopilot/ardupilot/start_command.h"
#include "controllers/autopilot/ardupilot/state_line.h"
#include "controllers/autopilot/frames/body_state.h"
#include "controllers/autopilot/mavlink/firmware_link.h"
#include "engine/api/may_fail.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table.h"
#include "engine/api/vehicle.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr int kOutputs = 32;
constexpr std::int64_t kMicrosecond_ns = 1000;

std::chrono::milliseconds milliseconds_of(double time_s) {
  return std::chrono::milliseconds(std::llround(1000.0 * time_s));
}

FirmwareLinkOptions link_options_of(const ArdupilotParams& params, bool uploads_parameters) {
  FirmwareLinkOptions options;
  if (!params.mission.empty()) options.mission = io::read_mission(params.mission);
  options.tolerance_m = params.plan_tolerance_m;
  options.gnss = params.gnss;
  options.station.ready_timeout_s = params.ready_timeout_s;
  for (const CommandRow& row : params.commands) {
    options.station.commands.push_back({row.at_s, row.command, row.params});
  }
  std::stable_sort(
      options.station.commands.begin(), options.station.commands.end(),
      [](const ScheduledCommand& a, const ScheduledCommand& b) { return a.at_s < b.at_s; });
  if (uploads_parameters) options.station.parameters = user_parameters(params);
  return options;
}

class Ardupilot final : public Autopilot, public MayFail {
 public:
  Ardupilot(const ArdupilotParams& params, std::unique_ptr<Lockstep> lockstep,
            const AutopilotContext& context, const std::string& type)
      : params_(params),
        who_(fmt::format("{} ({})", context.part, type)),
        part_(context.part),
        period_(context.period),
        vehicle_(*context.vehicle_truth),
        outputs_(*context.vehicle_description, params.mixer, params.channels, kOutputs, who_),
        actuators_(outputs_.make_actuators()),
        lockstep_(std::move(lockstep)) {
    if (period_.ns % kMicrosecond_ns != 0) {
      throw ConfigError(
          fmt::format("{}: its period is {:.9g} s; the autopilot counts whole microseconds", who_,
                      period_.s()));
    }
    constexpr std::size_t kRanges = std::tuple_size_v<decltype(ArdupilotState::ranges_m)>;
    if (params_.ranges.size() > kRanges) {
      throw ConfigError(fmt::format("{}: ranges has {} sensors; an autopilot takes {}", who_,
                                    params_.ranges.size(), kRanges));
    }
    std::stable_sort(params_.sticks.begin(), params_.sticks.end(),
                     [](const StickMove& a, const StickMove& b) { return a.at_s < b.at_s; });
    if (params_.uses_mavlink) {
      link_.emplace(
          link_options_of(params_, params_.command.empty()), context.origin,
          *context.vehicle_description, part_,
          [this](std::span<const std::uint8_t> bytes) { lockstep_->send_message(now_, bytes); });
    }
    for (int i = 1; i <= kOutputs; ++i) pulses_.names.push_back(fmt::format("servo_{}_us", i));
    pulses_.values.assign(kOutputs, 0.0);
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    if (!params_.imu.empty()) imu_ = ports.read<ImuSample>(params_.imu);
    for (const std::string& sensor : params_.ranges) {
      ranges_.push_back(ports.read<RangeSample>(sensor));
    }
    if (!params_.airspeed.empty()) airspeed_ = ports.read<AirData>(params_.airspeed);
    if (params_.battery_V > 0.0) battery_ = ports.read<BatteryState>("battery");
    actuators_writer_ = ports.write<NamedValues>("actuators");
    pulses_writer_ = ports.write<NamedValues>("servo_outputs");
    event_ = ports.write<Event>("autopilot_event");
    if (link_) link_->connect(ports);
  }

  void step(Time now) override {
    now_ = now;
    if (!has_begun_) {
      has_begun_ = true;
      begin_ = now;
      begin(now);
      event_.write(now, {Event::Level::kInfo, part_, "the autopilot has sent its first outputs"});
      listen(now);
    }
    // Without a reading there is nothing to send: a sensor may start later than the autopilot.
    if (imu_.connected() && !imu_.has_value()) return;
    ++steps_;
    fill(now);
    const std::string_view line = line_.write(state_);
    if (line.empty()) fail(now, "would get a state that is not finite");
    // What is sent now, the firmware reads in the step that the line starts.
    if (link_) link_->step(now);
    lockstep_->send_state(now, line);
    is_waiting_ = true;
  }

  void finish_step(Time now) override {
    if (!is_waiting_) return;
    is_waiting_ = false;
    take(now, lockstep_->wait_for_outputs(now));
    listen(now);
    for (std::size_t i = 0; i < packet_.pwm_us.size(); ++i) pulses_.values[i] = packet_.pwm_us[i];
    pulses_writer_.write(now, pulses_);
    outputs_.apply_pulses(std::span(packet_.pwm_us).first(packet_.channels), actuators_);
    actuators_writer_.write(now, actuators_);
  }

  bool finished() const override {
    if (link_ && link_->finished()) return true;
    return params_.finish_at_s > 0.0 &&
           static_cast<double>(steps_) * period_.s() >= params_.finish_at_s;
  }

  std::string_view failure() const override { return failure_; }

 private:
  [[noreturn]] void fail(Time now, const std::string& reason) const {
    throw SimulationError(who_, now, "the autopilot " + reason);
  }

  /// A port that is taken and a program that does not start show only now: before, the run may
  /// have been built without being run.
  void begin(Time now) {
    try {
      take(now, lockstep_->begin(now));
    } catch (const ConfigError& error) {
      const std::string text = error.what(), prefix = who_ + ": ";
      throw SimulationError(who_, now,
                            text.starts_with(prefix) ? text.substr(prefix.size()) : text);
    }
  }

  void take(Time now, const Result<ServoPacket>& packet) {
    if (!packet) fail(now, packet.reason());
    packet_ = *packet;
  }

  void listen(Time now) {
    if (!link_) return;
    for (auto bytes = lockstep_->next_message(now); !bytes.empty();
         bytes = lockstep_->next_message(now)) {
      link_->take(now, bytes);
    }
    for (const Event& event : link_->take_events()) event_.write(now, event);
    if (failure_.empty() && !link_->failure().empty()) {
      failure_ = "the autopilot " + link_->failure();
    }
  }

  /// Without a sensor: what ideal gyroscopes and accelerometers show on the mean since the last
  /// state, so that the firmware's estimator, which integrates them, gets the motion whole.
  ///   f_B = R_BW (dv_W / dt + g z), w_B dt = rotation vector of q_last^-1 q
  /// with R at half the rotation. The first state has the values of the instant.
  void measure_motion(Time now, const Odometry& truth) {
    const Eigen::Quaterniond& q_WB = truth.X_WB.q;
    const Eigen::Vector3d v_W = q_WB * truth.v_WB_B;
    Eigen::Vector3d w_B = truth.w_WB_B, f_B = vehicle_.specific_force_B();
    if (steps_ > 1) {
      const double dt_s = (now - last_time_).s();
      const Eigen::AngleAxisd turn(last_q_WB_.conjugate() * q_WB);
      w_B = turn.angle() / dt_s * turn.axis();
      const Eigen::Vector3d force_W =
          (v_W - last_v_W_) / dt_s + kStandardGravity_mps2 * Eigen::Vector3d::UnitZ();
      f_B = last_q_WB_.slerp(0.5, q_WB).conjugate() * force_W;
    }
    last_time_ = now;
    last_q_WB_ = q_WB;
    last_v_W_ = v_W;
    state_.gyro_FRD_radps = swap_frd_and_B(w_B);
    state_.specific_force_FRD_mps2 = swap_frd_and_B(f_B);
  }

  void fill(Time now) {
    const Odometry& truth = truth_.value();
    // ArduPilot adds each step truncated to whole microseconds. A nanosecond more in each keeps
    // rounding from losing one.
    state_.timestamp_s =
        1e-9 * static_cast<double>(static_cast<std::int64_t>(steps_) * (period_.ns + 1));
    state_.q_NED_FRD = q_NED_FRD_from(truth.X_WB.q);
    state_.position_NED_m = swap_ned_and_W(truth.X_WB.p);
    state_.velocity_NED_mps = swap_ned_and_W(truth.X_WB.q * truth.v_WB_B);
    if (imu_.connected()) {
      state_.gyro_FRD_radps = swap_frd_and_B(imu_.value().w_WS_S);
      state_.specific_force_FRD_mps2 = swap_frd_and_B(imu_.value().f_WS_S);
    } else {
      measure_motion(now, truth);
    }
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      // A field that is left out would keep its last value in the autopilot.
      constexpr double kNothing_m = 1.0;
      if (!ranges_[i].has_value()) {
        state_.ranges_m[i] = 0.0;
        continue;
      }
      const RangeSample& range = ranges_[i].value();
      state_.ranges_m[i] = std::min(range.range_m, range.max_range_m + kNothing_m);
    }
    if (airspeed_.has_value()) state_.airspeed_mps = airspeed_.value().v_air_B.x();
    if (battery_.has_value()) {
      state_.battery_V = params_.battery_V;
      state_.battery_A = battery_.value().power_W / params_.battery_V;
    }
    const double time_s = (now - begin_).s();
    while (next_stick_ < params_.sticks.size() && params_.sticks[next_stick_].at_s <= time_s) {
      const StickMove& move = params_.sticks[next_stick_++];
      state_.sticks_us[static_cast<std::size_t>(move.channel - 1)] =
          static_cast<std::uint16_t>(move.pulse_us);
    }
  }

  ArdupilotParams params_;
  std::string who_, part_;
  Duration period_;
  const Vehicle& vehicle_;
  OutputMap outputs_;
  NamedValues actuators_, pulses_;
  std::unique_ptr<Lockstep> lockstep_;
  ArdupilotState state_;
  StateLine line_;
  ServoPacket packet_;
  std::optional<FirmwareLink> link_;
  std::string failure_;
  Time now_;
  bool has_begun_ = false, is_waiting_ = false;
  std::uint64_t steps_ = 0;
  Time begin_;
  std::size_t next_stick_ = 0;
  Time last_time_;  ///< of the last state
  Eigen::Quaterniond last_q_WB_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d last_v_W_ = Eigen::Vector3d::Zero();

  SignalReader<Odometry> truth_;
  SignalReader<ImuSample> imu_;
  std::vector<SignalReader<RangeSample>> ranges_;
  SignalReader<AirData> airspeed_;
  SignalReader<BatteryState> battery_;
  SignalWriter<NamedValues> actuators_writer_, pulses_writer_;
  SignalWriter<Event> event_;
};

PartSpec spec_of(const char* name, const char* description, std::vector<ParameterSpec> parameters) {
  PartSpec spec;
  spec.name = name;
  spec.description = description;
  spec.parameters = std::move(parameters);
  spec.reads = {"truth", "plan (optional)", "battery (optional)"};
  spec.writes = {"actuators", "servo_outputs", "estimate", "follower", "autopilot_event"};
  return spec;
}

}  // namespace

PartSpec ardupilot_spec() {
  return spec_of("ardupilot",
                 "An unmodified ArduPilot (Rover, Copter, Plane) in lock-step by its JSON "
                 "interface: it gets a state for each step and drives the actuators.",
                 ardupilot_table().specs());
}

std::unique_ptr<Autopilot> make_ardupilot(const ParameterSet& parameters,
                                          const AutopilotContext& context) {
  const std::string who = context.part + " (ardupilot)";
  const ArdupilotParams params = ardupilot_table().read(parameters, who);
  const auto host = mavlink::parse_ipv4(params.address);
  if (!host) {
    throw ConfigError(fmt::format("{}: address = '{}', must be an IPv4 address such as 127.0.0.1",
                                  who, params.address));
  }
  RunningLockstepOptions options;
  options.own = {*host, static_cast<std::uint16_t>(lockstep_port_of(params))};
  if (params.uses_mavlink) {
    options.mavlink = {*host, static_cast<std::uint16_t>(mavlink_port_of(params))};
  }
  options.command = start_command(params, context);
  options.parameters = parameter_text(start_parameters(params, context));
  options.folder = context.folder;
  if (!params.record.empty()) {
    const std::filesystem::path file(params.record);
    if (file.filename() != file) {
      throw ConfigError(
          fmt::format("{}: record = '{}', must be a name without folders", who, params.record));
    }
    options.record = context.folder / file;
  }
  options.start_limit = milliseconds_of(params.start_timeout_s);
  options.answer_limit = milliseconds_of(params.answer_timeout_s);
  return std::make_unique<Ardupilot>(
      params, std::make_unique<RunningLockstep>(std::move(options), who), context, "ardupilot");
}

PartSpec autopilot_replay_spec() {
  return spec_of("replay",
                 "The recording of an autopilot in its place: the same outputs without it, as long "
                 "as the state is the recorded one.",
                 autopilot_replay_table().specs());
}

std::unique_ptr<Autopilot> make_autopilot_replay(const ParameterSet& parameters,
                                                 const AutopilotContext& context) {
  const std::string who = context.part + " (replay)";
  const AutopilotReplayParams params = autopilot_replay_table().read(parameters, who);
  return std::make_unique<Ardupilot>(
      params.of, std::make_unique<RecordedLockstep>(params.file, who), context, "replay");
}

}  // namespace vinerow::controllers
