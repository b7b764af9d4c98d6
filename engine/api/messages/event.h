#pragma once
/// The message that tells people what happened.
/// Frames and units: engine/api/messages.h.

#include <cstdint>
#include <string>

namespace vinerow {

/// What happened, for people: phase changes, contacts, warnings. ROS 2: rcl_interfaces/msg/Log.
struct Event {
  static constexpr const char* kType = "Event";
  enum class Level : std::uint8_t { kInfo = 20, kWarning = 30, kError = 40 };
  Level level = Level::kInfo;
  std::string source;  ///< "rover.controller"
  std::string text;

  template <class F>
  void fields(F&& f) {
    f(level), f(source), f(text);
  }
};

}  // namespace vinerow
