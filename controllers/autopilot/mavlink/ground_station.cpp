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
  for (const std::uint32_t message : {Attitude::kId, LocalPositionNed::kId, SysStatus::kId}) {
    const double rate_Hz = message == SysStatus::kId ? 1.0 : options_.report_rate_Hz;
    CommandLong command;
    command.command = kCommandSetMessageInterval;
    command.param1 = static_cast<float>(message);
    command.param2 = static_cast<float>(1e6 / rate_Hz);  // microseconds
    request(command);
  }
}

std::string GroundStation::last_complaint() const {
  return complaint_.empty() ? "" : fmt::format(" ({})", complaint_);
}

std::optional<std::uint32_t> GroundStation::auto_mode() const {
  // Numbers of ArduPilot's mode AUTO; PX4 has main mode 4 (auto), sub mode 4 (mission).
  if (heartbeat_.autopilot == kAutopilotPx4) return 4u << 24 | 4u << 16;
  switch (heartbeat_.type) {
    case kTypeGroundRover:
    case kTypeFixedWing:
      return 10;
    case kTypeQuadrotor:
      return 3;
    default:
      return std::nullopt;
  }
}

void GroundStation::take_heartbeat(Time now, const Frame& frame) {
  const auto heartbeat = read<Heartbeat>(frame);
  if (!heartbeat || heartbeat->autopilot == kAutopilotInvalid) return;
  heartbeat_ = *heartbeat;
  const bool armed = is_armed(heartbeat_);
  if (stage_ == Stage::kListen) {
    vehicle_ = frame.sender;
    enter(now, Stage::kReady);
  } else if (stage_ == Stage::kMode && heartbeat_.custom_mode == auto_mode()) {
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
    fail(fmt::format("refused the mode AUTO{}", last_complaint()));
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
    if (attitude_) estimate_ = FirmwareEstimate{now, *position, *attitude_};
  } else if (const auto status = read<SysStatus>(frame)) {
    const bool is_ready = (status->onboard_control_sensors_health & kSensorPrearmCheck) != 0;
    if (stage_ == Stage::kReady && is_ready && estimate_ && !options_.mission.empty()) {
      enter(now, Stage::kUpload);
    }
  } else if (const auto text = read<StatusText>(frame)) {
    constexpr std::uint8_t kWarning = 4;
    if (text->severity <= kWarning) complaint_ = text_of(text->text);
    texts_.push_back(*text);
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
    const bool is_last = reached->seq + 1 >= static_cast<int>(options_.mission.size());
    if (stage_ == Stage::kFlight && is_last) enter(now, Stage::kDone);
  }
}

void GroundStation::send_item(Time now, int number) {
  if (stage_ != Stage::kUpload) return;
  if (number >= static_cast<int>(options_.mission.size())) {
    return fail(
        fmt::format("asked for item {} of a mission of {}", number, options_.mission.size()));
  }
  MissionItemInt item = options_.mission[static_cast<std::size_t>(number)];
  item.target_system = vehicle_.system;
  item.target_component = vehicle_.component;
  item.seq = static_cast<std::uint16_t>(number);
  send_(writer_.write(item));
  // It goes on: the time for an answer starts again.
  stage_begin_ = last_request_ = now;
}

void GroundStation::step(Time now) {
  const double waited_s = (now - stage_begin_).s();
  const auto gives_up = [&](double limit_s, const char* what) {
    if (waited_s <= limit_s) return false;
    fail(fmt::format("{} for {:g} s{}", what, limit_s, last_complaint()));
    return true;
  };
  switch (stage_) {
    case Stage::kListen:
    case Stage::kReady:
      if (!options_.mission.empty() &&
          gives_up(options_.ready_timeout_s, "was not ready to be armed")) {
        break;
      }
      if (stage_ == Stage::kReady && !estimate_ && is_due(now)) request_streams();
      break;
    case Stage::kUpload:
      if (gives_up(options_.answer_timeout_s, "did not take the mission") || !is_due(now)) break;
      {
        MissionCount count;
        count.target_system = vehicle_.system;
        count.target_component = vehicle_.component;
        count.count = static_cast<std::uint16_t>(options_.mission.size());
        count.mission_type = kAllMissions;
        send_(writer_.write(count));
      }
      break;
    case Stage::kMode: {
      const auto mode = auto_mode();
      if (!mode) {
        fail(fmt::format("is a vehicle of type {}, for which no mode AUTO is known",
                         heartbeat_.type));
        break;
      }
      if (gives_up(options_.answer_timeout_s, "did not change to AUTO") || !is_due(now)) break;
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
      if (gives_up(options_.answer_timeout_s, "was not armed") || !is_due(now)) break;
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

std::vector<StatusText> GroundStation::take_texts() {
  return std::exchange(texts_, {});
}

}  // namespace vinerow::controllers
