#pragma once
/// A scenario that is loaded once, run as often as wanted, and stepped by whoever holds it:
///
///   Session session = open_session("riseholme_rover.yaml");   // vinerow/session.h
///   const SignalView<Odometry> truth = session.signal<Odometry>("rover/truth");
///   while (!session.over()) {
///     session.advance(session.now() + Duration{50'000'000});
///     follow(truth.value());
///   }
///   session.reset(2);  // the same scenario with another seed, and nothing is read or built twice
///
/// A session does not own the loop, starts no thread that outlives a call, and never reads the wall
/// clock. One session belongs to one thread at a time; any number of them run side by side
/// (`twin()`). What it computes is what a process of its own would compute, to the bit, however it
/// is stepped. docs/session.md tells more.

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

namespace io {
struct Scenario;
}
class Simulation;

/// Where a session keeps one of its signals: found anew after a reset, empty after the session.
struct SignalSlot {
  std::string name;
  const SignalBase* signal = nullptr;
};

/// Looks at a signal without copying it. Cheap to copy; stays good across reset().
template <class T>
class SignalView {
 public:
  SignalView() = default;
  explicit SignalView(std::shared_ptr<const SignalSlot> slot) : slot_(std::move(slot)) {}

  /// It has been written since the last reset, and its session lives.
  bool has_value() const { return sequence() > 0; }
  /// The last value written; changes with the next advance(). @pre has_value()
  const T& value() const {
    VINEROW_DEMAND(has_value());
    return reader().value();
  }
  /// When it was written; of a sensor with a delay, when it was measured. @pre has_value()
  Time stamp() const {
    VINEROW_DEMAND(has_value());
    return reader().stamp();
  }
  /// Number of writes so far by its present writer.
  std::uint64_t sequence() const { return reader().sequence(); }
  /// True once per advance() in which it was written, when asked after each.
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
  std::string writer;  ///< e.g. "rover.controller", "outside"; empty: nobody, now
};

/// What a part told people, and when.
struct SessionEvent {
  Time time;
  Event event;
};

/// The end of a vehicle.
struct SessionCrash {
  std::string vehicle;
  Time time;
  std::string text;  ///< "hit the ground at 2.3 m/s"
};

/// How a mission's phase stands.
struct SessionPhase {
  std::string name;
  std::string state;  ///< "waiting", "running", "succeeded", "failed", "blocked", ...
  std::optional<Time> begin, end;
  std::string reason;                     ///< one sentence, where it did not succeed
  std::map<std::string, double> numbers;  ///< of a job
};

struct SessionOptions {
  /// Signals that are written by command() in place of a part: those that the scenario's parts read
  /// and none of them writes.
  std::vector<OutsideSignal> outside;
  /// Folder for what the jobs of a mission make; empty: one that goes with the session.
  std::filesystem::path products;

  /// E.g. take_over<NamedValues>("rover/actuators") of a vehicle without a controller.
  template <class T>
  SessionOptions& take_over(std::string signal) {
    outside.push_back(outside_signal<T>(std::move(signal)));
    return *this;
  }
};

class Session {
 public:
  /// Builds everything, up to the first instant. @param registry  not null
  /// @throws ConfigError
  Session(const io::Scenario& scenario, std::shared_ptr<const Registry> registry,
          SessionOptions options = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// Another session of the same scenario, seed and options, at its begin, for another thread: it
  /// shares the world and what was read from files. Its mission's products go into a folder of its
  /// own.
  Session twin() const;

  /// Begins again. Views stay good; commands that wait and events not taken are dropped. Reads no
  /// file that was read before, and builds the world anew only where it depends on the seed.
  /// @throws ConfigError, and then nothing has changed
  void reset(std::uint64_t seed);
  /// With the same seed.
  void reset();

  /// Works on every instant up to `until`, that one included, or to the end of the run. Nothing
  /// happens where `until` is before now().
  /// @throws ConfigError when the run is over or broke off before; on a plan that cannot be made
  /// @throws SimulationError when it breaks off; what was reached can still be read
  void advance(Time until);
  /// Works on the instants of so long a time from now() on: advance_for(a), advance_for(b) is
  /// advance_for(a + b).
  void advance_for(Duration duration);
  /// The next instant to be worked on: 0 at the begin. Commands may bear this stamp or a later one.
  Time now() const;
  /// From one instant to the next.
  Duration step() const;
  /// Number of steps that physics has made.
  std::uint64_t steps() const;
  /// No further step will be made.
  bool over() const;
  /// Every controller has finished and no vehicle crashed; of a mission: every phase succeeded.
  bool finished() const;

  /// Lets a signal take this value at the first instant that is not before `stamp`, before any part
  /// runs. The signal must have been taken over (SessionOptions). Its stamp on the bus is that
  /// instant; it goes into the digest and the log as any other does. Where several values fall
  /// into one instant the one with the latest stamp counts, of equal stamps the last one given.
  /// @throws ConfigError on a signal that is unknown, written by a part, or of another type; a
  ///   stamp before now(); a value that holds NaN; actuators that the vehicle does not have; when
  ///   over
  template <class T>
  void command(const std::string& signal, Time stamp, const T& value) {
    command(outside_command<T>(signal, stamp, value));
  }
  void command(OutsideCommand command);

  /// @throws ConfigError naming the nearest signal, or the type it has
  template <class T>
  SignalView<T> signal(const std::string& name) {
    return SignalView<T>(slot(name, T::kType));
  }
  /// A signal of any type. Not valid after the next reset(). @throws ConfigError
  const SignalBase& any_signal(const std::string& name) const;
  /// All of them, in the same order in every run of a scenario.
  std::vector<SignalInfo> signals() const;

  /// In the scenario's order.
  std::vector<std::string> vehicles() const;
  /// [vehicle][metric], and of a mission's jobs [phase][number], as they stand now.
  std::map<std::string, std::map<std::string, double>> metrics() const;
  std::vector<SessionCrash> crashes() const;
  /// Of a mission, in the scenario's order; empty without one.
  std::vector<SessionPhase> phases() const;
  /// Events since the last call, or since the begin.
  std::vector<SessionEvent> take_events();
  /// Over every signal written so far (docs/architecture.md).
  std::string digest() const;
  std::uint64_t seed() const;

  /// Of this run, with its resolved text; not valid after the next reset().
  const io::Scenario& scenario() const;
  /// The run itself (engine/sim/simulation.h, private), for observers in the tree; not
  /// valid after the next reset().
  Simulation& simulation();
  const Simulation& simulation() const;

 private:
  struct Impl;
  explicit Session(std::unique_ptr<Impl> impl);
  std::shared_ptr<const SignalSlot> slot(const std::string& name, const char* type);
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow
