#pragma once
/// Event message: reports to people what happened. Frames and units: engine/api/messages.h.

#include <cstdint>
#include <span>
#include <string>

#include "engine/api/field.h"

namespace vinerow {

/// Report for people: phase changes, contacts, warnings. ROS 2: rcl_interfaces/msg/Log.
struct Event {
  static constexpr const char* kType = "Event";
  enum class Level : std::uint8_t { kInfo = 20, kWarning = 30, kError = 40 };
  Level level = Level::kInfo;
  std::string source;  ///< "rover.controller"
  std::string text;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"level"}, self.level);
    f({"source"}, self.source);
    f({"text"}, self.text);
  }
};

inline std::span<const EnumName> enum_names(Event::Level) {
  using enum Event::Level;
  static constexpr EnumName kNames[] = {
      enum_name(kInfo, "INFO"),
      enum_name(kWarning, "WARN"),
      enum_name(kError, "ERROR")};
  return kNames;
}

}  // namespace vinerow
