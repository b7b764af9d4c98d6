#pragma once
/// Age of commands from outside: a vehicle stops when its commander falls silent.

#include <fmt/format.h>

#include <string>
#include <utility>

#include "engine/api/messages/event.h"
#include "engine/api/signal.h"
#include "engine/core/time.h"

namespace vinerow::controllers {

inline constexpr double kCommandTimeout_s = 0.5;  // as in ROS 2's diff_drive_controller
inline constexpr const char* kCommandTimeoutWords =
    "stop if the last command is older, in simulated time; 0 = a command holds until the next";

/// Simulated time decides, so a replay of the commands stops at the same instants.
class CommandWatch {
 public:
  /// @param timeout_s  0: none. @param part  for the event. @param signal  local name
  CommandWatch(double timeout_s, std::string part, std::string signal)
      : timeout_(duration_from_s(timeout_s)), part_(std::move(part)), signal_(std::move(signal)) {}

  void connect(Ports& ports) { event_ = ports.write<Event>("controller_event"); }

  /// Once per cycle. @returns false if there is no command, or only one that is too old. Reports
  /// the moment when it becomes so.
  template <class T>
  bool is_fresh(Time now, const SignalReader<T>& command) {
    const bool is_fresh =
        command.has_value() && (timeout_.ns <= 0 || (now - command.stamp()).ns <= timeout_.ns);
    if (was_fresh_ && !is_fresh) {
      event_.write(now, {Event::Level::kWarning, part_,
                         fmt::format("no {} for {:g} s: the vehicle stops", signal_, timeout_.s())});
    }
    was_fresh_ = is_fresh;
    return is_fresh;
  }

 private:
  Duration timeout_;
  std::string part_;
  std::string signal_;
  bool was_fresh_ = false;
  SignalWriter<Event> event_;
};

}  // namespace vinerow::controllers
