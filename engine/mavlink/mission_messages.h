#pragma once
/// Mission protocol: upload, download and progress of the items of a mission.
/// Source: message set "common" of MAVLink.

#include <array>
#include <cstdint>

#include "engine/mavlink/message.h"

namespace vinerow::mavlink {

/// Asks for an item; the older form.
struct MissionRequest {
  static constexpr std::uint32_t kId = 40;
  static constexpr const char* kName = "MISSION_REQUEST";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t seq = 0;
  std::uint8_t mission_type = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"seq"}, self.seq);
    f(Field{"mission_type", true}, self.mission_type);
  }
};

struct MissionSetCurrent {
  static constexpr std::uint32_t kId = 41;
  static constexpr const char* kName = "MISSION_SET_CURRENT";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t seq = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"seq"}, self.seq);
  }
};

/// The item that is being worked on.
struct MissionCurrent {
  static constexpr std::uint32_t kId = 42;
  static constexpr const char* kName = "MISSION_CURRENT";
  std::uint16_t seq = 0;
  std::uint16_t total = 0;
  std::uint8_t mission_state = 0;
  std::uint8_t mission_mode = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"seq"}, self.seq);
    f(Field{"total", true}, self.total);
    f(Field{"mission_state", true}, self.mission_state);
    f(Field{"mission_mode", true}, self.mission_mode);
  }
};

/// Begins a download.
struct MissionRequestList {
  static constexpr std::uint32_t kId = 43;
  static constexpr const char* kName = "MISSION_REQUEST_LIST";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t mission_type = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"mission_type", true}, self.mission_type);
  }
};

/// Begins an upload, or answers the request for a download.
struct MissionCount {
  static constexpr std::uint32_t kId = 44;
  static constexpr const char* kName = "MISSION_COUNT";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t count = 0;
  std::uint8_t mission_type = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"count"}, self.count);
    f(Field{"mission_type", true}, self.mission_type);
  }
};

struct MissionClearAll {
  static constexpr std::uint32_t kId = 45;
  static constexpr const char* kName = "MISSION_CLEAR_ALL";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t mission_type = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"mission_type", true}, self.mission_type);
  }
};

struct MissionItemReached {
  static constexpr std::uint32_t kId = 46;
  static constexpr const char* kName = "MISSION_ITEM_REACHED";
  std::uint16_t seq = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"seq"}, self.seq);
  }
};

/// Ends an upload or a download.
struct MissionAck {
  static constexpr std::uint32_t kId = 47;
  static constexpr const char* kName = "MISSION_ACK";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t type = 0;
  std::uint8_t mission_type = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"type"}, self.type);
    f(Field{"mission_type", true}, self.mission_type);
  }
};

/// Asks for an item.
struct MissionRequestInt {
  static constexpr std::uint32_t kId = 51;
  static constexpr const char* kName = "MISSION_REQUEST_INT";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t seq = 0;
  std::uint8_t mission_type = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"seq"}, self.seq);
    f(Field{"mission_type", true}, self.mission_type);
  }
};

/// An item of a mission.
struct MissionItemInt {
  static constexpr std::uint32_t kId = 73;
  static constexpr const char* kName = "MISSION_ITEM_INT";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t seq = 0;
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
  std::uint8_t mission_type = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"target_system"}, self.target_system);
    f(Field{"target_component"}, self.target_component);
    f(Field{"seq"}, self.seq);
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
    f(Field{"mission_type", true}, self.mission_type);
  }
};

}  // namespace vinerow::mavlink
