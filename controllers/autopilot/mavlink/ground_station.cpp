#include "controllers/autopilot/mavlink/ground_station.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/mavlink/enums.h"

namespace vinerow::controllers {
namespace {

using namespace mavlink;

constexpr double kRepeat_s = 1.0;
constexpr std::uint8_t kAllMissions = 0;  // MAV_MISSION_TYPE_MISSION

std::string name_of_type(std::uint8_t type) {
  switch (type) {
    case kTypeGroundRover:
      return "a rover";
    case kTypeQuadrotor:
      return "a quadrotor";
    case kTypeFixedWing:
      return "a fixed wing";
    default:
      return fmt::format("a vehicle of type {}", type);
  }
}

bool is_armed(const Heartbeat& heartbeat) {
  return (heartbeat.base_mode & kModeFlagArmed) != 0;
}

}  // namespace

GroundStation::GroundStation(GroundStationOptions options, Send send)
    : options_(std::move(options)), send_(std::move(send)) {}

void GroundStation::enter(Time now, Stage stage) {
  stage_ = stage;
  stage_begin_ = now;
  has_requested_ = false;
}

void GroundStation::fail(const std::string& reason) {
  failure_ = reason;
  stage_ = Stage::kFailed;
}

bool GroundStation::is_due(Time now) {
  if (has_requested_ && (now - last_request_).s() < kRepeat_s) return false;
  has_requested_ = true;
  last_request_ = now;
  return true;
}

void GroundStation::request(const CommandLong& command) {
  CommandLong addressed = command;
  addressed.target_system = vehicle_.system;
  addressed.target_component = vehicle_.component;
  send_(writer_.write(addressed));
}

void GroundStation::request_streams() {
  for (const std::uint32_t message : {EkfStatusReport::kId, Attitude::kId, LocalPositionNed::kId,
                                      NavControllerOutput::kId, SysStatus::kId}) {
    const double rate_Hz = message == SysStatus::kId ? 1.0 : options_.report_rate_Hz;
    CommandLong command;
    command.command = kCommandSetMessageInterval;
    command.param1 = static_cast<float>(message);
    command.param2 = static_cast<float>(1e6 / rate_Hz);  // microseconds
    request(command);
  }
  request_origin();
}

void GroundStation::request_origin() {
  CommandLong origin;
  origin.command = kCommandRequestMessage;
  origin.param1 = static_cast<float>(GpsGlobalOrigin::kId);
  request(origin);
}

void GroundStation::take_ekf_status(const EkfStatusReport& status) {
  const bool knows = (status.flags & kEkfKnowsPlace) != 0;
  // Before, positions come from a simpler estimator, whose origin has no altitude.
  if (!knows || !knows_place_) origin_.reset();
  if (knows && !origin_) request_origin();
  knows_place_ = knows;
}

ParameterEncoding GroundStation::encoding() const {
  return heartbeat_.autopilot == kAutopilotPx4 ? ParameterEncoding::kBytewise
                                               : ParameterEncoding::kConverted;
}

void GroundStation::send_parameter() {
  const FirmwareParameter& wanted = options_.parameters[next_parameter_];
  if (encoding() == ParameterEncoding::kBytewise && !parameter_type_) {
    // Its answer has the type: whether it is a whole number.
    ParamRequestRead question;
    question.target_system = vehicle_.system;
    question.target_component = vehicle_.component;
    set_text(question.param_id, wanted.name);
    send_(writer_.write(question));
    return;
  }
  ParamSet set;
  set.target_system = vehicle_.system;
  set.target_component = vehicle_.component;
  set_text(set.param_id, wanted.name);
  set.param_type = parameter_type_.value_or(kParameterReal32);
  set.param_value = to_wire(wanted.value, set.param_type, encoding());
  send_(writer_.write(set));
}

void GroundStation::next_parameter(Time now) {
  ++next_parameter_;
  parameter_type_.reset();
  enter(now, next_parameter_ < options_.parameters.size() ? Stage::kParameters : Stage::kReady);
}

void GroundStation::take_parameter(Time now, const ParamValue& value) {
  if (stage_ != Stage::kParameters) return;
  const FirmwareParameter& wanted = options_.parameters[next_parameter_];
  if (text_of(value.param_id) != wanted.name) return;
  const double has = from_wire(value.param_value, value.param_type, encoding());
  if (static_cast<float>(has) == static_cast<float>(wanted.value)) return next_parameter(now);
  if (encoding() == ParameterEncoding::kBytewise && !parameter_type_) {
    parameter_type_ = value.param_type;
    has_requested_ = false;
    return;
  }
  // Parameters of whole numbers come back as such.
  fail(fmt::format("keeps its parameter {} at {:g} instead of {:g}", wanted.name, has,
                   wanted.value));
}

void GroundStation::take_text(const StatusText& piece) {
  for (SpokenText& text : pieces_.take(piece)) {
    if (text.severity <= kSeverityWarning) complaint_ = text.text;
    texts_.push_back(std::move(text));
  }
}

void GroundStation::send_commands(Time now) {
  if (stage_ == Stage::kListen) return;
  const double time_s = (now - *begin_).s();
  while (next_command_ < options_.commands.size() &&
         options_.commands[next_command_].at_s <= time_s) {
    const ScheduledCommand& wanted = options_.commands[next_command_++];
    CommandLong command;
    command.command = static_cast<std::uint16_t>(wanted.command);
    float* const places[] = {&command.param1, &command.param2, &command.param3, &command.param4,
                             &command.param5, &command.param6, &command.param7};
    for (std::size_t i = 0; i < std::min(wanted.params.size(), std::size(places)); ++i) {
      *places[i] = static_cast<float>(wanted.params[i]);
    }
    request(command);
  }
}

std::string GroundStation::last_complaint() const {
  return complaint_.empty() ? "" : fmt::format(" ({})", complaint_);
}

std::optional<std::uint32_t> GroundStation::arming_mode() const {
  // Numbers of ArduPilot's modes: AUTO, but its copters are armed in GUIDED and change to AUTO when
  // the mission starts. PX4 has main mode 4 (auto), sub mode 4 (mission).
  if (heartbeat_.autopilot == kAutopilotPx4) return 4u << 24 | 4u << 16;
  switch (heartbeat_.type) {
    case kTypeGroundRover:
    case kTypeFixedWing:
      return 10;
    case kTypeQuadrotor:
      return 4;
    default:
      return std::nullopt;
  }
}

void GroundStation::meet(Time now, const Frame& frame) {
  vehicle_ = frame.sender;
  const std::uint8_t wanted = options_.vehicle_type.value_or(heartbeat_.type);
  if (heartbeat_.type != wanted) {
    return fail(fmt::format("is firmware for {}, and this is {}", name_of_type(heartbeat_.type),
                            name_of_type(wanted)));
  }
  enter(now, options_.parameters.empty() ? Stage::kReady : Stage::kParameters);
}

void GroundStation::take_heartbeat(Time now, const Frame& frame) {
  const auto heartbeat = read<Heartbeat>(frame);
  if (!heartbeat || heartbeat->autopilot == kAutopilotInvalid) return;
  heartbeat_ = *heartbeat;
  const bool armed = is_armed(heartbeat_);
  if (stage_ == Stage::kListen) {
    meet(now, frame);
  } else if (stage_ == Stage::kMode && heartbeat_.custom_mode == arming_mode()) {
    enter(now, Stage::kArm);
  } else if (stage_ == Stage::kArm && armed) {
    enter(now, Stage::kStart);
  } else if (stage_ == Stage::kFlight && was_armed_ && !armed) {
    enter(now, Stage::kDone);
  }
  was_armed_ = armed;
}

void GroundStation::take_ack(Time now, const CommandAck& ack) {
  const bool is_refused = ack.result != kResultAccepted && ack.result != kResultInProgress &&
                          ack.result != kResultTemporarilyRejected;
  if (stage_ == Stage::kStart && ack.command == kCommandMissionStart && !is_refused) {
    enter(now, Stage::kFlight);
  } else if (stage_ == Stage::kMode && ack.command == kCommandSetMode && is_refused) {
    fail(fmt::format("refused the mode for missions{}", last_complaint()));
  }
}

void GroundStation::take_mission_ack(Time now, const MissionAck& ack) {
  if (stage_ != Stage::kUpload) return;
  if (ack.type == kMissionAccepted) return enter(now, Stage::kMode);
  fail(fmt::format("refused the mission: {}{}", mission_result_name(ack.type), last_complaint()));
}

void GroundStation::take(Time now, const Frame& frame) {
  if (frame.id == Heartbeat::kId) return take_heartbeat(now, frame);
  if (stage_ == Stage::kListen || frame.sender.system != vehicle_.system) return;
  if (const auto attitude = read<Attitude>(frame)) {
    attitude_ = attitude;
  } else if (const auto position = read<LocalPositionNed>(frame)) {
    if (attitude_ && origin_ && knows_place_)
      estimate_ = FirmwareEstimate{now, *position, *attitude_, *origin_};
  } else if (const auto origin = read<GpsGlobalOrigin>(frame)) {
    origin_ = origin;
  } else if (const auto ekf_status = read<EkfStatusReport>(frame)) {
    take_ekf_status(*ekf_status);
  } else if (const auto current = read<MissionCurrent>(frame)) {
    current_item_ = current->seq;
  } else if (const auto navigation = read<NavControllerOutput>(frame)) {
    navigation_ = navigation;
  } else if (const auto parameter = read<ParamValue>(frame)) {
    take_parameter(now, *parameter);
  } else if (const auto status = read<SysStatus>(frame)) {
    is_ready_ = (status->onboard_control_sensors_health & kSensorPrearmCheck) != 0;
    if (stage_ == Stage::kReady && is_ready_ && estimate_ && !mission_.empty()) {
      enter(now, Stage::kUpload);
    }
  } else if (const auto text = read<StatusText>(frame)) {
    take_text(*text);
  } else if (const auto request_int = read<MissionRequestInt>(frame)) {
    send_item(now, request_int->seq);
  } else if (const auto request_float = read<MissionRequest>(frame)) {
    send_item(now, request_float->seq);
  } else if (const auto mission_ack = read<MissionAck>(frame)) {
    take_mission_ack(now, *mission_ack);
  } else if (const auto ack = read<CommandAck>(frame)) {
    take_ack(now, *ack);
  } else if (const auto reached = read<MissionItemReached>(frame)) {
    items_reached_ = std::max(items_reached_, reached->seq + 1);
    const bool is_last = reached->seq + 1 >= static_cast<int>(mission_.size());
    if (stage_ == Stage::kFlight && is_last) enter(now, Stage::kDone);
  }
}

void GroundStation::send_item(Time now, int number) {
  if (stage_ != Stage::kUpload) return;
  if (number >= static_cast<int>(mission_.size())) {
    return fail(fmt::format("asked for item {} of a mission of {}", number, mission_.size()));
  }
  MissionItemInt item = mission_[static_cast<std::size_t>(number)];
  item.target_system = vehicle_.system;
  item.target_component = vehicle_.component;
  item.seq = static_cast<std::uint16_t>(number);
  send_(writer_.write(item));
  // It goes on: the time for an answer starts again.
  stage_begin_ = last_request_ = now;
}

void GroundStation::step(Time now) {
  if (!begin_) begin_ = now;
  send_commands(now);
  const double waited_s = (now - stage_begin_).s();
  const auto gives_up = [&](double limit_s, const char* what) {
    if (waited_s <= limit_s) return false;
    fail(fmt::format("{} for {:g} s{}", what, limit_s, last_complaint()));
    return true;
  };
  switch (stage_) {
    case Stage::kListen:
    case Stage::kReady:
      if (options_.expects_mission &&
          gives_up(options_.ready_timeout_s, "was not ready to be armed")) {
        break;
      }
      if (stage_ == Stage::kReady && !estimate_ && is_due(now)) request_streams();
      break;
    case Stage::kParameters:
      if (waited_s > options_.answer_timeout_s) {
        return fail(fmt::format("has no parameter {}: it gave no answer for {:g} s",
                                options_.parameters[next_parameter_].name,
                                options_.answer_timeout_s));
      }
      if (is_due(now)) send_parameter();
      break;
    case Stage::kUpload:
      if (gives_up(options_.answer_timeout_s, "did not take the mission") || !is_due(now)) break;
      {
        MissionCount count;
        count.target_system = vehicle_.system;
        count.target_component = vehicle_.component;
        count.count = static_cast<std::uint16_t>(mission_.size());
        count.mission_type = kAllMissions;
        send_(writer_.write(count));
      }
      break;
    case Stage::kMode: {
      const auto mode = arming_mode();
      if (!mode) {
        fail(fmt::format("is a vehicle of type {}, whose mode for missions is unknown",
                         heartbeat_.type));
        break;
      }
      if (gives_up(options_.answer_timeout_s, "did not change to the mode for missions") ||
          !is_due(now))
        break;
      CommandLong command;
      command.command = kCommandSetMode;
      command.param1 = kModeFlagCustom;
      if (heartbeat_.autopilot == kAutopilotPx4) {  // main and sub mode
        command.param2 = static_cast<float>(*mode >> 16 & 0xFF);
        command.param3 = static_cast<float>(*mode >> 24);
      } else {
        command.param2 = static_cast<float>(*mode);
      }
      request(command);
      break;
    }
    case Stage::kArm: {
      // Its checks go on: while it says that it is not ready, it is not asked.
      if (gives_up(options_.ready_timeout_s, "was not armed") || !is_ready_ || !is_due(now)) break;
      CommandLong command;
      command.command = kCommandArm;
      command.param1 = 1.0F;
      request(command);
      break;
    }
    case Stage::kStart: {
      if (gives_up(options_.answer_timeout_s, "did not start the mission") || !is_due(now)) break;
      CommandLong command;
      command.command = kCommandMissionStart;
      request(command);
      break;
    }
    case Stage::kFlight:
    case Stage::kDone:
    case Stage::kFailed:
      break;
  }
}

std::vector<SpokenText> GroundStation::take_texts() {
  return std::exchange(texts_, {});
}

}  // namespace vinerow::controllers
