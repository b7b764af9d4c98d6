#pragma once
/// Lock-step: simulated time waits for the command that is stamped for the instant.
///
/// Commands are due at the multiples of a period but 0. The peer sees the signals of one instant
/// and answers with the command for the next one that is due.

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "engine/core/time.h"
#include "engine/live/peer_command.h"
#include "engine/scenario/scenario.h"

namespace vinerow::live {

/// Not thread-safe.
class Lockstep {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param options  with a signal
  explicit Lockstep(scenario::LockstepConfig options);

  const scenario::LockstepConfig& options() const { return options_; }
  /// The run starts again at time 0.
  void restart();

  /// Next instant that needs a command.
  Time due() const { return due_; }
  /// True after a timeout after which the run goes on, until the next command.
  bool is_suspended() const { return is_suspended_; }

  /// @returns "" or the reason why the command is refused
  std::string add(PeerCommand command);
  /// Takes the command of due(), if it is there; the next instant is due then.
  std::optional<PeerCommand> take();
  /// Call while the command of due() is missing. @returns true when the timeout has passed
  bool has_timed_out(Clock::time_point now);
  /// Goes on without commands. @param now  next instant of the run
  void suspend(Time now);
  /// Call before each slice of a suspended run.
  void pass(Time now);

 private:
  scenario::LockstepConfig options_;
  Time due_;
  std::map<std::int64_t, PeerCommand> commands_;  ///< by stamp, ns
  std::optional<Clock::time_point> waiting_since_;
  bool is_suspended_ = false;
};

}  // namespace vinerow::live
