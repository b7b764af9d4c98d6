#pragma once
/// Session: a scenario that is loaded once, stepped by the calling program, and reset as often as
/// needed:
///
///   Session session = open_session("riseholme_rover.yaml");   // vinerow/session.h
///   const SignalView<Odometry> truth = session.signal<Odometry>("rover/truth");
///   while (!session.over()) {
///     session.advance(session.now() + Duration{50'000'000});
///     follow(truth.value());
///   }
///   session.reset(2);  // the same scenario with another seed; nothing is read or built twice
///
/// A session does not own the loop, starts no thread that outlives a call, and never reads the wall
/// clock. Only one thread may use a session at a time; any number of sessions can run in parallel
/// (`twin()`). However it is stepped, its results are bit-identical to those of a separate process.
/// Guide: docs/guides/session.md.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages.h"
#include "engine/api/outside.h"
#include "engine/api/registry.h"
#include "engine/api/signal.h"
#include "engine/core/time.h"

namespace vinerow {

namespace scenario {
struct Scenario;
}
class RunShelf;
class Simulation;

/// A session's reference to one of its signals. reset() looks the signal up again; the session's
/// destructor sets it to null.
struct SignalSlot {
  std::string name;
  const SignalBase* signal = nullptr;
};

/// Refers to a signal's value without copying it. Cheap to copy; remains valid across reset().
template <class T>
class SignalView {
 public:
  SignalView() = default;
  explicit SignalView(std::shared_ptr<const SignalSlot> slot) : slot_(std::move(slot)) {}

  /// True if the signal was written since the last reset and the session still exists.
  bool has_value() const { return sequence() > 0; }
  /// The last value written; changes with the next advance(). @pre has_value()
  const T& value() const {
    VINEROW_DEMAND(has_value());
    return reader().value();
  }
  /// Time of the write; for a sensor with a delay, of the measurement. @pre has_value()
  Time stamp() const {
    VINEROW_DEMAND(has_value());
    return reader().stamp();
  }
  /// Number of writes so far by the present writer.
  std::uint64_t sequence() const { return reader().sequence(); }
  /// True if the signal was written since the last call with the same `seen`.
  bool is_newer_than(std::uint64_t& seen) const { return reader().is_newer_than(seen); }

 private:
  /// @pre the slot's signal has this type, which Session::signal() has checked
  SignalReader<T> reader() const {
    return SignalReader<T>(slot_ ? static_cast<const Signal<T>*>(slot_->signal) : nullptr);
  }
  std::shared_ptr<const SignalSlot> slot_;
};

struct SignalInfo {
  std::string name;    ///< "rover/truth"
  std::string type;    ///< of the message, e.g. "Odometry"
  std::string writer;  ///< e.g. "rover.controller", "outside"; empty if it has no writer now
};

/// An event that a part reported, and when.
struct SessionEvent {
  Time time;
  Event event;
};

/// A vehicle that crashed.
struct SessionCrash {
  std::string vehicle;
  Time time;
  std::string text;  ///< "hit the ground at 2.3 m/s"
};

/// State of one phase of a mission.
struct SessionPhase {
  std::string name;
  std::string state;  ///< "waiting", "running", "succeeded", "failed", "blocked", ...
  std::optional<Time> begin, end;
  std::string reason;                     ///< one sentence, if it did not succeed
  std::map<std::string, double> numbers;  ///< of a job
};

struct SessionOptions {
  /// Signals that command() writes in place of a part. A part of the scenario must read each of
  /// them, and no part may write it.
  std::vector<OutsideSignal> outside;
  /// Folder for the products of a mission's jobs. If empty, a temporary folder is used, which is
  /// removed with the session.
  std::filesystem::path products;
  /// Cache of worlds and file contents, shared with sessions of other scenarios
  /// (engine/sim/run_shelf.h, private). If null, the session has its own.
  std::shared_ptr<RunShelf> shelf;
  /// No job runs and no firmware starts, for a check of the first instant.
  bool is_rehearsal = false;

  /// E.g. take_over<NamedValues>("rover/actuators") of a vehicle without a controller.
  template <class T>
  SessionOptions& take_over(std::string signal) {
    outside.push_back(outside_signal<T>(std::move(signal)));
    return *this;
  }
};

class Session {
 public:
  /// Builds everything; now() is 0. @param registry  not null
  /// @throws ConfigError
  Session(const scenario::Scenario& scenario, std::shared_ptr<const Registry> registry,
          SessionOptions options = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// Another session of the same scenario, seed and options, at time 0, for another thread. It
  /// shares the world and file contents with this one, and has its own folder for products.
  Session twin() const;

  /// Restarts at time 0 with another seed. Views remain valid; pending commands and events that
  /// were not taken are dropped. Reads no unchanged file again, and rebuilds the world only if it
  /// depends on the seed.
  /// @throws ConfigError; the session is then unchanged
  void reset(std::uint64_t seed);
  /// Restarts with the same seed.
  void reset();

  /// Processes every instant up to and including `until`, or to the end of the run. Does nothing if
  /// `until` is before now().
  /// @throws ConfigError if the run is over or has failed before, or a plan cannot be made
  /// @throws SimulationError if the run fails; its results so far remain readable
  void advance(Time until);
  /// Processes the instants of the next `duration`: advance_for(a), advance_for(b) equals
  /// advance_for(a + b).
  void advance_for(Duration duration);
  /// The next instant to be processed, 0 at the start; also the earliest valid stamp of a command.
  Time now() const;
  /// Time between two instants.
  Duration step() const;
  /// Number of physics steps so far.
  std::uint64_t steps() const;
  /// The run has ended: by its duration, because all vehicles finished, or by a crash.
  bool over() const;
  /// Every controller has finished and no vehicle crashed; in a mission, every phase succeeded.
  bool finished() const;

  /// Sets a signal at the first instant at or after `stamp`, before any part runs. The session must
  /// have taken it over (SessionOptions). Its stamp on the bus is that instant; digest and log
  /// contain it like any other value. Of several values for one instant, the one with the latest
  /// stamp counts; if stamps are equal, the last one given.
  /// @throws ConfigError on a signal that is unknown, written by a part, or of another type; a
  ///   stamp before now(); a value that contains NaN; actuators that the vehicle does not have; if
  ///   the run is over
  template <class T>
  void command(const std::string& signal, Time stamp, const T& value) {
    command(outside_command<T>(signal, stamp, value));
  }
  void command(OutsideCommand command);

  /// View of a signal. @throws ConfigError with the most similar name, or with the signal's type
  template <class T>
  SignalView<T> signal(const std::string& name) {
    return SignalView<T>(slot(name, T::kType));
  }
  /// A signal of any type. Not valid after the next reset(). @throws ConfigError
  const SignalBase& any_signal(const std::string& name) const;
  /// All signals, in the same order in every run of a scenario.
  std::vector<SignalInfo> signals() const;

  /// Names of the vehicles, in the scenario's order.
  std::vector<std::string> vehicles() const;
  /// Present values: [vehicle][metric], and for a mission's jobs [phase][number].
  std::map<std::string, std::map<std::string, double>> metrics() const;
  std::vector<SessionCrash> crashes() const;
  /// Phases of a mission, in the scenario's order; empty without a mission.
  std::vector<SessionPhase> phases() const;
  /// Events since the last call, or since time 0.
  std::vector<SessionEvent> take_events();
  /// Digest of every signal written so far (docs/concepts/determinism.md).
  std::string digest() const;
  std::uint64_t seed() const;

  /// Keeps the memory of the present run's signals, also after reset() and beyond the session: for
  /// views without a copy in other languages. The values then no longer change.
  std::shared_ptr<const void> run_memory() const;

  /// Scenario of this run, with its resolved text; not valid after the next reset().
  const scenario::Scenario& scenario() const;
  /// The run itself (engine/sim/simulation.h, private), for observers inside the project; not valid
  /// after the next reset().
  Simulation& simulation();
  const Simulation& simulation() const;

 private:
  struct Impl;
  explicit Session(std::unique_ptr<Impl> impl);
  std::shared_ptr<const SignalSlot> slot(const std::string& name, const char* type);
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow
