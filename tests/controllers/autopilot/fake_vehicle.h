#pragma once
/// A vehicle that speaks MAVLink's heartbeat, command, mission and parameter protocols.

#include <bit>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/mavlink/enums.h"
#include "engine/mavlink/frame.h"
#include "engine/mavlink/messages.h"

namespace vinerow::controllers::autopilot_fake {

using namespace mavlink;

/// Behaves as an ArduPilot rover does, in steps of 0.1 s; with PX4's number also as PX4.
struct FakeVehicle {
  using Bytes = std::vector<std::uint8_t>;
  std::uint8_t type = kTypeGroundRover;
  std::uint8_t autopilot = kAutopilotArdupilot;
  double ready_at_s = 5.0;
  int loses = 0;  ///< number of frames of the ground station that are lost first
  std::uint8_t mission_result = kMissionAccepted;
  bool refuses_to_arm = false;
  std::string prearm;
  std::map<std::string, float> parameters;
  std::map<std::string, std::int32_t> whole_parameters;  ///< PX4 alone has them

  std::vector<MissionItemInt> items;
  std::size_t wanted = 0;
  std::uint32_t mode = 4;  // HOLD
  bool is_armed = false;
  bool has_started = false;
  int uploads = 0;
  std::vector<std::pair<float, float>> intervals;  ///< message, microseconds
  std::vector<CommandLong> other_commands;
  std::vector<GpsInput> fixes;
  GpsGlobalOrigin origin;
  LocalPositionNed position;
  Attitude attitude;

  FrameWriter writer{Sender{1, 1}};
  FrameReader reader;
  std::vector<Bytes> to_station;

  template <class M>
  void send(const M& message) {
    const auto frame = writer.write(message);
    to_station.emplace_back(frame.begin(), frame.end());
  }

  void take(std::span<const std::uint8_t> bytes) {
    if (loses > 0) {
      --loses;
      return;
    }
    reader.read(bytes, [this](const Frame& frame) { answer(frame); });
  }

  /// No answer where there is no such parameter, as ArduPilot.
  void tell_parameter(const std::string& name) {
    ParamValue value;
    set_text(value.param_id, name);
    if (const auto whole = whole_parameters.find(name); whole != whole_parameters.end()) {
      value.param_type = kParameterInt32;
      value.param_value = std::bit_cast<float>(whole->second);
    } else if (const auto known = parameters.find(name); known != parameters.end()) {
      value.param_type = kParameterReal32;
      value.param_value = known->second;
    } else {
      return;
    }
    send(value);
  }

  void ask_or_accept() {
    if (wanted < items.size()) {
      MissionRequestInt request;
      request.target_system = 255;
      request.seq = static_cast<std::uint16_t>(wanted);
      return send(request);
    }
    MissionAck ack;
    ack.type = mission_result;
    send(ack);
  }

  void answer(const Frame& frame) {
    if (const auto count = read<MissionCount>(frame)) {
      ++uploads;
      items.assign(count->count, {});
      wanted = 0;
      ask_or_accept();
    } else if (const auto item = read<MissionItemInt>(frame)) {
      if (item->seq != wanted) return;
      items[wanted++] = *item;
      ask_or_accept();
    } else if (const auto command = read<CommandLong>(frame)) {
      CommandAck ack;
      ack.command = command->command;
      switch (command->command) {
        case kCommandSetMessageInterval:
          intervals.emplace_back(command->param1, command->param2);
          break;
        case kCommandSetMode:
          mode = static_cast<std::uint32_t>(command->param2);
          if (autopilot == kAutopilotPx4) {  // main and sub mode
            mode = mode << 16 | static_cast<std::uint32_t>(command->param3) << 24;
          }
          break;
        case kCommandArm:
          if (refuses_to_arm) {
            ack.result = kResultFailed;
            StatusText text;
            text.severity = 2;
            set_text(text.text, "Arm: Throttle not neutral");
            send(text);
          } else {
            is_armed = true;
          }
          break;
        case kCommandMissionStart:
          has_started = true;
          break;
        case kCommandRequestMessage:
          send(origin);
          break;
        default:
          other_commands.push_back(*command);
          ack.result = kResultUnsupported;
      }
      send(ack);
    } else if (const auto set = read<ParamSet>(frame)) {
      const std::string name(text_of(set->param_id));
      if (const auto whole = whole_parameters.find(name); whole != whole_parameters.end()) {
        if (set->param_type == kParameterInt32) {
          whole->second = std::bit_cast<std::int32_t>(set->param_value);
        }
      }
      const auto known = parameters.find(name);
      if (known != parameters.end() && name != "FIXED") known->second = set->param_value;
      tell_parameter(name);
    } else if (const auto question = read<ParamRequestRead>(frame)) {
      tell_parameter(std::string(text_of(question->param_id)));
    } else if (const auto fix = read<GpsInput>(frame)) {
      fixes.push_back(*fix);
    }
  }

  void step(double time_s) {
    Heartbeat heartbeat;
    heartbeat.type = type;
    heartbeat.autopilot = autopilot;
    heartbeat.custom_mode = mode;
    heartbeat.base_mode = is_armed ? kModeFlagArmed : 0;
    send(heartbeat);
    for (const auto& [message, interval_us] : intervals) {
      if (message == Attitude::kId) send(attitude);
      if (message == LocalPositionNed::kId) send(position);
    }
    SysStatus status;
    if (time_s >= ready_at_s) status.onboard_control_sensors_health = kSensorPrearmCheck;
    send(status);
    if (!prearm.empty() && time_s < ready_at_s) {
      StatusText text;
      text.severity = 2;
      set_text(text.text, prearm);
      send(text);
    }
  }
};

}  // namespace vinerow::controllers::autopilot_fake
