#pragma once
/// Control over a run from other threads: pause, step, speed, reset, commands, lock-step.
///
/// Peers (clients of the server, ROS 2 nodes) call from their threads; the run calls next() between
/// two slices. Wall time decides only when the run goes on, and at which instant a command is
/// given. Commands are signals "from outside", which the log contains with the instant at which
/// they took effect, so `vinerow run --replay-commands` repeats the run without the peers.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/live/lockstep.h"
#include "engine/live/pacer.h"
#include "engine/live/peer_command.h"
#include "engine/run/run_driver.h"

namespace vinerow::live {

enum class RunState { kStarting, kPlaying, kPaused, kOver };

/// The run as its peers see it.
struct RunSnapshot {
  RunState state = RunState::kStarting;
  Time now;                 ///< next instant to be processed
  std::uint64_t steps = 0;  ///< physics steps so far
  std::uint64_t seed = 0;
  std::uint64_t restarts = 0;
  double speed = 0.0;             ///< wanted: simulated per wall time; 0 = as fast as possible
  double real_time_factor = 0.0;  ///< measured over the last second
};

struct ControlOptions {
  double speed = 1.0;   ///< 0 = as fast as possible
  bool paused = false;  ///< at the start
  std::optional<scenario::LockstepConfig> lockstep = {};
};

class RunControl final : public run::RunDriver {
 public:
  enum class Level { kInfo = 0, kWarning = 1, kError = 2 };
  /// Receives sentences for people: a speed that cannot be held, a peer that fell silent.
  using Notify = std::function<void(Level, const std::string&)>;

  RunControl(ControlOptions options, Notify notify);

  // From any thread.

  RunSnapshot snapshot() const;
  void pause();
  void resume();
  /// @param speed  simulated seconds per second of wall time, 0 = as fast as possible
  /// @returns "" or the reason why the value is refused
  std::string set_speed(double speed);
  /// Makes exactly `steps` physics steps and pauses again. @param answer  when they are made;
  /// refused unless the run is paused
  void step(std::uint64_t steps, Answer answer);
  /// Starts the run again at time 0. @param seed  absent: the same
  void reset(std::optional<std::uint64_t> seed, Answer answer);
  /// Keeps the run at time 0 until release_start(), at most for the timeout of the lock-step: its
  /// peers would miss the first messages.
  void hold_start();
  void release_start();
  /// Ends the run; its files are written.
  void stop(const std::string& reason);
  /// Gives the run a command at its next instant, or in lock-step at its stamp. A signal belongs to
  /// the peer that commands it until that peer leaves or is silent for a second.
  /// @returns "" or the reason why it is refused
  std::string submit(PeerCommand command);
  /// The peer has left.
  void release(const std::string& peer);

  // From the run's thread.

  void begin(Session& session) override;
  Next next(Session& session, Time slice_end) override;
  void end(Session& session) override;

 private:
  using Clock = std::chrono::steady_clock;
  using Lock = std::unique_lock<std::mutex>;

  struct Owner {
    std::string peer;
    Clock::time_point last;
  };

  void poke();
  void note_progress(const Session& session);
  /// Waits until poked, at most kLongestWait. @returns whether it was
  bool wait(Lock& lock, Clock::duration longest);
  /// Gives the commands to the session, without the lock.
  static void give(Session& session, std::vector<PeerCommand> commands);
  /// Waits for the command of the next instant, and limits `until` to the instants before the one
  /// that needs another. @returns false while the command is missing
  bool await_lockstep(Lock& lock, Session& session, Time& until,
                      std::vector<PeerCommand>& commands);
  void wait_for_start(Lock& lock, const Session& session);
  std::string describe_owner(const std::string& signal) const;

  const Notify notify_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  RunSnapshot snapshot_;
  bool paused_ = false;
  bool is_held_ = false;
  std::optional<Clock::time_point> held_since_;
  std::uint64_t steps_left_ = 0;
  Answer step_answer_;
  std::optional<std::uint64_t> reset_seed_;
  std::vector<Answer> reset_answers_;
  std::string stop_reason_;
  bool poked_ = false;                   ///< something changed since the run's thread last looked
  std::vector<std::string> signals_;     ///< written from outside
  std::map<std::string, Owner> owners_;  ///< by signal
  std::map<std::string, PeerCommand> waiting_;  ///< by signal: of several, the last one counts
  std::optional<Lockstep> lockstep_;
  Pacer pacer_;
};

}  // namespace vinerow::live
