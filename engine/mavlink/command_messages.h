#pragma once
/// Commands, modes and parameters.
/// Source: message set "common" of MAVLink.

#include <array>
#include <cstdint>

#include "engine/mavlink/message.h"

namespace vinerow::mavlink {

struct SetMode {
  static constexpr std::uint32_t kId = 11;
  static constexpr const char* kName = "SET_MODE";
  std::uint8_t target_system = 0;
  std::uint8_t base_mode = 0;
  std::uint32_t custom_mode = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"base_mode"}, self.base_mode);
    f(Field{"custom_mode"}, self.custom_mode);
  }
};

/// Asks for one parameter, by its name or its index.
struct ParamRequestRead {
  static constexpr std::uint32_t kId = 20;
  static constexpr const char* kName = "PARAM_REQUEST_READ";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  std::int16_t param_index = -1;  ///< -1: by name

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"param_id"}, self.param_id);
    f(Field{"param_index"}, self.param_index);
  }
};

/// Asks for all parameters.
struct ParamRequestList {
  static constexpr std::uint32_t kId = 21;
  static constexpr const char* kName = "PARAM_REQUEST_LIST";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
  }
};

struct ParamValue {
  static constexpr std::uint32_t kId = 22;
  static constexpr const char* kName = "PARAM_VALUE";
  std::array<char, 16> param_id{};
  float param_value = 0;
  std::uint8_t param_type = 0;
  std::uint16_t param_count = 0;
  std::uint16_t param_index = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"param_id"}, self.param_id);
    f(Field{"param_value"}, self.param_value);
    f(Field{"param_type"}, self.param_type);
    f(Field{"param_count"}, self.param_count);
    f(Field{"param_index"}, self.param_index);
  }
};

struct ParamSet {
  static constexpr std::uint32_t kId = 23;
  static constexpr const char* kName = "PARAM_SET";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  float param_value = 0;
  std::uint8_t param_type = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"param_id"}, self.param_id);
    f(Field{"param_value"}, self.param_value);
    f(Field{"param_type"}, self.param_type);
  }
};

/// Older way to ask for rates.
struct RequestDataStream {
  static constexpr std::uint32_t kId = 66;
  static constexpr const char* kName = "REQUEST_DATA_STREAM";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t req_stream_id = 0;
  std::uint16_t req_message_rate = 0;  ///< Hz
  std::uint8_t start_stop = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"req_stream_id"}, self.req_stream_id);
    f(Field{"req_message_rate"}, self.req_message_rate);
    f(Field{"start_stop"}, self.start_stop);
  }
};

/// A command with a place.
struct CommandInt {
  static constexpr std::uint32_t kId = 75;
  static constexpr const char* kName = "COMMAND_INT";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t frame = 0;
  std::uint16_t command = 0;
  std::uint8_t current = 0;
  std::uint8_t autocontinue = 0;
  float param1 = 0;
  float param2 = 0;
  float param3 = 0;
  float param4 = 0;
  std::int32_t x = 0;  ///< 1e-7 deg
  std::int32_t y = 0;  ///< 1e-7 deg
  float z = 0;         ///< m

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"frame"}, self.frame);
    f(Field{"command"}, self.command);
    f(Field{"current"}, self.current);
    f(Field{"autocontinue"}, self.autocontinue);
    f(Field{"param1"}, self.param1);
    f(Field{"param2"}, self.param2);
    f(Field{"param3"}, self.param3);
    f(Field{"param4"}, self.param4);
    f(Field{"x"}, self.x);
    f(Field{"y"}, self.y);
    f(Field{"z"}, self.z);
  }
};

/// A command.
struct CommandLong {
  static constexpr std::uint32_t kId = 76;
  static constexpr const char* kName = "COMMAND_LONG";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t command = 0;
  std::uint8_t confirmation = 0;
  float param1 = 0;
  float param2 = 0;
  float param3 = 0;
  float param4 = 0;
  float param5 = 0;
  float param6 = 0;
  float param7 = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"command"}, self.command);
    f(Field{"confirmation"}, self.confirmation);
    f(Field{"param1"}, self.param1);
    f(Field{"param2"}, self.param2);
    f(Field{"param3"}, self.param3);
    f(Field{"param4"}, self.param4);
    f(Field{"param5"}, self.param5);
    f(Field{"param6"}, self.param6);
    f(Field{"param7"}, self.param7);
  }
};

/// What became of a command.
struct CommandAck {
  static constexpr std::uint32_t kId = 77;
  static constexpr const char* kName = "COMMAND_ACK";
  std::uint16_t command = 0;
  std::uint8_t result = 0;
  std::uint8_t progress = 0;
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"command"}, self.command);
    f(Field{"result"}, self.result);
    f(Field{"progress", true}, self.progress);
    f(Field{"result_param2", true}, self.result_param2);
    f(Field{"target_system", true}, self.target_system);
    f(Field{"target_component", true}, self.target_component);
  }
};

/// Where to go, as an outer loop says it.
struct SetPositionTargetLocalNed {
  static constexpr std::uint32_t kId = 84;
  static constexpr const char* kName = "SET_POSITION_TARGET_LOCAL_NED";
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t coordinate_frame = 0;
  std::uint16_t type_mask = 0;  ///< bits of the fields that do not count
  float x = 0;                  ///< m
  float y = 0;                  ///< m
  float z = 0;                  ///< m
  float vx = 0;                 ///< m/s
  float vy = 0;                 ///< m/s
  float vz = 0;                 ///< m/s
  float afx = 0;                ///< m/s2
  float afy = 0;                ///< m/s2
  float afz = 0;                ///< m/s2
  float yaw = 0;                ///< rad
  float yaw_rate = 0;           ///< rad/s

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_boot_ms"}, self.time_boot_ms);
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"coordinate_frame"}, self.coordinate_frame);
    f(Field{"type_mask"}, self.type_mask);
    f(Field{"x"}, self.x);
    f(Field{"y"}, self.y);
    f(Field{"z"}, self.z);
    f(Field{"vx"}, self.vx);
    f(Field{"vy"}, self.vy);
    f(Field{"vz"}, self.vz);
    f(Field{"afx"}, self.afx);
    f(Field{"afy"}, self.afy);
    f(Field{"afz"}, self.afz);
    f(Field{"yaw"}, self.yaw);
    f(Field{"yaw_rate"}, self.yaw_rate);
  }
};

}  // namespace vinerow::mavlink
