#include "controllers/autopilot/firmware/firmware_autopilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr std::int64_t kMicrosecond_ns = 1000;

std::chrono::milliseconds milliseconds_of(double time_s) {
  return std::chrono::milliseconds(std::llround(1000.0 * time_s));
}

}  // namespace

PartSpec firmware_spec(const char* name, const char* description) {
  PartSpec spec;
  spec.name = name;
  spec.description = description;
  spec.reads = {"truth", "plan (optional)", "battery (optional)"};
  spec.writes = {"actuators", "servo_outputs", "estimate", "follower", "autopilot_event"};
  return spec;
}

FirmwareLinkOptions firmware_link_options(const FirmwareParams& params) {
  FirmwareLinkOptions options;
  if (!params.mission.empty()) options.mission = io::read_mission(params.mission);
  options.tolerance_m = params.plan_tolerance_m;
  options.station.ready_timeout_s = params.ready_timeout_s;
  for (const CommandRow& row : params.commands) {
    options.station.commands.push_back({row.at_s, row.command, row.params});
  }
  std::stable_sort(
      options.station.commands.begin(), options.station.commands.end(),
      [](const ScheduledCommand& a, const ScheduledCommand& b) { return a.at_s < b.at_s; });
  options.station.parameters = user_parameters(params);
  return options;
}

std::vector<FirmwareParameter> user_parameters(const FirmwareParams& params) {
  std::vector<FirmwareParameter> parameters;
  if (!params.parameter_file.empty()) parameters = read_parameter_file(params.parameter_file);
  for (const ParameterRow& row : params.parameters) {
    set_parameter(parameters, {row.name, row.value});
  }
  return parameters;
}

RunningLockstepOptions running_options(const FirmwareParams& params, Protocol protocol, int port,
                                       int mavlink_port, const AutopilotContext& context,
                                       const std::string& who) {
  const auto host = mavlink::parse_ipv4(params.address);
  if (!host) {
    throw ConfigError(fmt::format("{}: address = '{}', must be an IPv4 address such as 127.0.0.1",
                                  who, params.address));
  }
  RunningLockstepOptions options;
  options.own = {*host, static_cast<std::uint16_t>(port)};
  if (params.uses_mavlink) options.mavlink = {*host, static_cast<std::uint16_t>(mavlink_port)};
  const std::string run = context.folder.parent_path().string();
  options.claims.push_back(std::make_shared<PortClaim>(run, protocol, options.own, who));
  if (options.mavlink) {
    options.claims.push_back(
        std::make_shared<PortClaim>(run, Protocol::kUdp, *options.mavlink, who));
  }
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
  return options;
}

std::string find_program(const std::string& name, const char* variable) {
  const char* folder = std::getenv(variable);
  if (folder == nullptr || name.find('/') != std::string::npos) return name;
  std::error_code ignored;
  for (const char* below : {"", "bin"}) {
    const std::filesystem::path program = std::filesystem::path(folder) / below / name;
    if (std::filesystem::is_regular_file(program, ignored)) return program.string();
  }
  return name;
}

FirmwareAutopilot::FirmwareAutopilot(double finish_at_s, std::optional<FirmwareLinkOptions> link,
                                     std::unique_ptr<Lockstep> lockstep,
                                     std::unique_ptr<Dialect> dialect,
                                     const AutopilotContext& context, const std::string& type)
    : finish_at_s_(finish_at_s),
      who_(fmt::format("{} ({})", context.part, type)),
      part_(context.part),
      period_(context.period),
      lockstep_(std::move(lockstep)),
      dialect_(std::move(dialect)),
      actuators_(dialect_->make_actuators()) {
  if (period_.ns % kMicrosecond_ns != 0) {
    throw ConfigError(fmt::format(
        "{}: its period is {:.9g} s; the autopilot counts whole microseconds", who_, period_.s()));
  }
  if (link) {
    link_.emplace(std::move(*link), context.origin, *context.vehicle_description, part_,
                  [this](Bytes bytes) { lockstep_->send_message(now_, bytes); });
  }
}

void FirmwareAutopilot::connect(Ports& ports) {
  dialect_->connect(ports);
  actuators_writer_ = ports.write<NamedValues>("actuators");
  outputs_writer_ = ports.write<NamedValues>("servo_outputs");
  event_ = ports.write<Event>("autopilot_event");
  if (link_) link_->connect(ports);
}

void FirmwareAutopilot::step(Time now) {
  now_ = now;
  // Without a reading there is nothing to send: a sensor may start later than the autopilot.
  if (const std::string_view sensor = dialect_->missing_sensor(); !sensor.empty()) {
    return wait_for_sensor(now, sensor);
  }
  if (!has_begun_) {
    has_begun_ = true;
    begin(now);
    event_.write(now, {Event::Level::kInfo, part_, "the autopilot has sent its first outputs"});
    listen(now);
  }
  ++steps_;
  const auto state = dialect_->write_state(now);
  if (!state) fail(now, state.reason());
  // What is sent now, the firmware reads in the step that the state starts.
  if (link_) link_->step(now);
  lockstep_->send_state(now, *state);
  is_waiting_ = true;
}

void FirmwareAutopilot::finish_step(Time now) {
  if (!is_waiting_) return;
  is_waiting_ = false;
  const auto outputs = lockstep_->wait_for_outputs(now);
  if (!outputs) fail(now, outputs.reason());
  check(now, dialect_->take_outputs(*outputs, actuators_));
  listen(now);
  outputs_writer_.write(now, dialect_->outputs());
  actuators_writer_.write(now, actuators_);
}

bool FirmwareAutopilot::finished() const {
  if (link_ && link_->finished()) return true;
  return finish_at_s_ > 0.0 && static_cast<double>(steps_) * period_.s() >= finish_at_s_;
}

void FirmwareAutopilot::fail(Time now, const std::string& reason) const {
  throw SimulationError(who_, now, "the autopilot " + reason);
}

void FirmwareAutopilot::check(Time now, const std::string& fault) const {
  if (!fault.empty()) fail(now, fault);
}

/// A port that is taken and a program that does not start show only now: before, the run may have
/// been built without being run.
void FirmwareAutopilot::begin(Time now) {
  try {
    const auto outputs = lockstep_->begin(
        now, [this](std::uint64_t number) { return dialect_->boot_state(number); });
    if (!outputs) fail(now, outputs.reason());
    check(now, dialect_->begin(now, *outputs));
  } catch (const ConfigError& error) {
    const std::string text = error.what(), prefix = who_ + ": ";
    throw SimulationError(who_, now, text.starts_with(prefix) ? text.substr(prefix.size()) : text);
  }
}

void FirmwareAutopilot::wait_for_sensor(Time now, std::string_view sensor) {
  constexpr double kPatience_s = 10.0;
  if (!first_step_) first_step_ = now;
  if (has_complained_ || (now - *first_step_).s() < kPatience_s) return;
  has_complained_ = true;
  event_.write(now, {Event::Level::kWarning, part_,
                     fmt::format("the autopilot waits for the first reading of '{}'", sensor)});
}

void FirmwareAutopilot::listen(Time now) {
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

}  // namespace vinerow::controllers
