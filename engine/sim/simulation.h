#pragma once
/// One run of one scenario: builds the parts, connects the signals, steps. Writes no files.
///
/// At each instant t = k * physics step: truth is published; then the stages sense, estimate, plan,
/// guide, control, actuate, payload and judge (metrics) run; observers see the instant, and the
/// digest is updated with every signal written; then physics advances the state to t + step, and
/// the state is checked. In a mission (mission.h) the phases are updated first of all.

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
#include "engine/sim/run_observer.h"
#include "engine/sim/scheduler.h"

namespace vinerow {

class Mission;
class Separation;
class TrafficControl;
struct RunContext;
class VehicleRays;
class VehicleRuntime;

/// Inputs of a run besides its scenario.
struct SimulationSetup {
  /// Folder for the products of a mission's jobs. If empty, a temporary folder is used, which is
  /// removed with the simulation.
  std::filesystem::path products;
  std::optional<BuiltWorld> world;  ///< of this scenario and seed; built if absent
  std::vector<OutsideSignal> outside;
  FileShelf* shelf = nullptr;  ///< outlives the simulation
  bool is_rehearsal = false;   ///< no job runs and no firmware starts
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

  /// Adds an observer, called at every instant from now on; not owned.
  void add_observer(RunObserver* observer) { observers_.push_back(observer); }

  /// Queues a value for a signal that is written from outside (SimulationSetup::outside).
  /// @throws ConfigError as OutsideCommands::add, and on actuators that the vehicle does not have
  void command(OutsideCommand command);
  /// Signals that command() may write.
  const std::vector<std::string>& outside_signals() const { return outside_.signals(); }

  /// Builds now what the first rays, distances and contacts would build: for runs that a clock
  /// paces.
  void prepare() const { world_.scene->prepare(); }
  /// Runs until the run is over or `end` is reached; can be called again to continue.
  /// @throws SimulationError
  void run_until(Time end);
  /// Runs to the scenario's end.
  void run();
  /// No further step will be made: the duration is over, every controller has finished or its
  /// vehicle crashed, or a vehicle crashed whose crash ends the run.
  bool over() const { return over_; }
  /// Every controller has finished and no vehicle crashed; in a mission, every phase succeeded.
  bool finished() const;
  /// Phases of a mission, in the file's order; empty without a mission.
  std::vector<PhaseReport> phases() const;
  /// In the vehicles' order.
  std::vector<Crash> crashes() const;
  /// The next instant to be processed.
  Time now() const { return now_; }
  std::uint64_t steps() const { return steps_; }

  /// Digest of every signal written so far, except events and diagnostics (link poses, wheel
  /// states): they follow from the other signals, and their rate depends on the log settings.
  std::string digest() const { return hasher_.hex(); }

  /// metrics[vehicle][metric], and for a mission's jobs [phase][number]. Call when over().
  std::map<std::string, std::map<std::string, double>> metrics() const;
  /// Numbers that planners reported: [vehicle][number].
  std::map<std::string, std::map<std::string, double>> planning() const;
  /// True pose and twist of a vehicle now. @throws ConfigError for an unknown name
  const Odometry& truth(const std::string& vehicle) const;
  const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles() const { return vehicles_; }

  /// Writes an event to "run/events" and notifies the observers.
  void emit(Event::Level level, const std::string& source, const std::string& text);

 private:
  void work_instant();
  /// Decides which signals belong to the digest. Call when all known signals exist.
  void classify_signals();
  void end_mission();
  void check_lockstep() const;
  void add_traffic(const RunContext& run);
  void watch_separation(Time now);
  /// No vehicle has anything left to do, or a crash ends the run.
  bool is_done() const;
  /// Copies events that parts wrote to their own signals to "run/events".
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
  std::unique_ptr<VehicleRays> vehicle_rays_;  // null until a camera asks
  std::filesystem::path own_products_;         // temporary folder; empty if the caller gave one
  std::unique_ptr<Mission> mission_;           // null: no phases
  std::unique_ptr<TrafficControl> traffic_;    // null: alleys are not reserved
  std::vector<std::pair<std::string, std::string>> lost_vehicles_;  // deadlocked vehicles; reasons
  std::unique_ptr<Separation> separation_;                          // null: not measured
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

/// Builds the world of a scenario. @param shelf  cache of files; may be null. @throws ConfigError
std::unique_ptr<WorldModel> build_world(const scenario::Scenario& scenario,
                                        const Registry& registry, FileShelf* shelf = nullptr);

}  // namespace vinerow
