#pragma once
/// One run of one scenario: builds the parts, wires the signals, steps. No files are written here.
///
/// At each instant t = k * physics step: truth is published, then sense, estimate, plan, guide,
/// control, actuate, judge (metrics); observers see the instant and the digest takes in every
/// signal written; then physics carries the state to t + step and is checked. Of a mission
/// (mission.h) the phases are looked at first of all.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/messages/event.h"
#include "engine/api/messages/grid.h"
#include "engine/api/registry.h"
#include "engine/core/hash.h"
#include "engine/physics/physics_world.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/built_world.h"
#include "engine/sim/crash.h"
#include "engine/sim/outside_commands.h"
#include "engine/sim/phase_report.h"
#include "engine/sim/scheduler.h"

namespace vinerow {

class Mission;
class Separation;
class TrafficControl;
struct RunContext;
class VehicleRuntime;

/// Looks at a run without changing it.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Everything of this instant is written, physics has not yet moved on.
  virtual void on_instant(Time /*now*/) {}
  /// The signal "run/events" has just been written.
  virtual void on_event(Time /*now*/, const Event& /*event*/) {}
};

/// What a run may be given beside its scenario.
struct SimulationSetup {
  /// Folder for what the jobs of a mission make; empty: one that goes with the simulation.
  std::filesystem::path products;
  std::optional<BuiltWorld> world;  ///< of this scenario and seed; absent: built here
  std::vector<OutsideSignal> outside;
  FileShelf* shelf = nullptr;  ///< outlives the simulation
};

class Simulation {
 public:
  /// Builds everything. @param registry must outlive the simulation
  /// @throws ConfigError
  Simulation(const scenario::Scenario& scenario, const Registry& registry, SimulationSetup setup);
  Simulation(const scenario::Scenario& scenario, const Registry& registry)
      : Simulation(scenario, registry, SimulationSetup{}) {}
  ~Simulation();

  const scenario::Scenario& scenario() const { return scenario_; }
  const WorldModel& world() const { return *world_.model; }
  const BuiltWorld& built_world() const { return world_; }
  const SignalBus& bus() const { return bus_; }
  physics::PhysicsWorld& physics() { return *physics_; }
  Scheduler& scheduler() { return scheduler_; }

  /// Called at every instant from now on; not owned.
  void add_observer(RunObserver* observer) { observers_.push_back(observer); }

  /// Takes a value in for a signal that is written from outside (SimulationSetup::outside).
  /// @throws ConfigError as OutsideCommands::add, and on actuators that the vehicle does not have
  void command(OutsideCommand command);

  /// Runs until the mission is over, or `end` is reached; can be called again to go on.
  /// @throws SimulationError
  void run_until(Time end);
  /// Runs to the scenario's end.
  void run();
  /// No further step will be made: the duration is over, every controller has finished or lost its
  /// vehicle, or a vehicle crashed whose crash ends the run.
  bool over() const { return over_; }
  /// Every controller said that it has finished, and no vehicle crashed; of a mission: every phase
  /// succeeded.
  bool finished() const;
  /// Of a mission, in the file's order; empty without one.
  std::vector<PhaseReport> phases() const;
  /// In the vehicles' order.
  std::vector<Crash> crashes() const;
  /// The next instant to be worked on.
  Time now() const { return now_; }
  std::uint64_t steps() const { return steps_; }

  /// Digest over every signal written so far, events and diagnostics (link poses, wheel states)
  /// excepted: they follow from the others, and their rate belongs to the log.
  std::string digest() const { return hasher_.hex(); }

  /// metrics[vehicle][metric], and of a mission's jobs [phase][number]. Call when over().
  std::map<std::string, std::map<std::string, double>> metrics() const;
  /// What planners told of their work: [vehicle][number].
  std::map<std::string, std::map<std::string, double>> planning() const;
  /// True pose and twist of a vehicle now. @throws ConfigError for an unknown name
  const Odometry& truth(const std::string& vehicle) const;
  const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles() const { return vehicles_; }

  /// Writes to "run/events" and tells the observers.
  void emit(Event::Level level, const std::string& source, const std::string& text);

 private:
  void work_instant();
  /// Which signals go into the digest, once all that are known are there.
  void classify_signals();
  void end_mission();
  void add_traffic(const RunContext& run);
  void watch_separation(Time now);
  /// Nobody has anything left to do, or a crash ends the run.
  bool is_done() const;
  /// Hands what parts wrote as events of their own to "run/events".
  void pass_on_events();
  void hash_new_signals();
  void step_physics();

  scenario::Scenario scenario_;
  BuiltWorld world_;
  std::unique_ptr<physics::PhysicsWorld> physics_;
  SignalBus bus_;
  OutsideCommands outside_;
  Scheduler scheduler_;
  std::vector<std::unique_ptr<VehicleRuntime>> vehicles_;
  std::filesystem::path own_products_;       // removed with the simulation; empty: not its own
  std::unique_ptr<Mission> mission_;         // null: none
  std::unique_ptr<TrafficControl> traffic_;  // null: alleys are not reserved
  std::vector<std::pair<std::string, std::string>> lost_vehicles_;  // wait for ever; and why
  std::unique_ptr<Separation> separation_;                          // null: fewer than two vehicles
  SignalWriter<Event> events_;
  SignalWriter<OccupancyGrid> map_;
  std::vector<std::pair<const Signal<Event>*, std::uint64_t>>
      part_events_;  // and the sequence seen
  std::vector<RunObserver*> observers_;
  std::vector<std::uint64_t> hashed_sequence_;  // per signal of the bus
  std::vector<bool> hashed_;                    // per signal: part of the digest
  Hasher hasher_;
  Time now_;
  std::uint64_t steps_ = 0;
  bool over_ = false;
};

/// The world of a scenario. @param shelf  of files; null: none. @throws ConfigError
std::unique_ptr<WorldModel> build_world(const scenario::Scenario& scenario,
                                        const Registry& registry, FileShelf* shelf = nullptr);

}  // namespace vinerow
