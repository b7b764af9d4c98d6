#pragma once
/// Building of the parts of one vehicle from its scenario: map, sensors, estimator, observers,
/// planner, guidance, controller, payloads and metrics, connected in this order and scheduled.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/registry.h"
#include "engine/api/world_model.h"
#include "engine/physics/physics_world.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/map_ground.h"
#include "engine/sim/scheduler.h"

namespace vinerow {

class MayFail;

/// Objects of the run that are needed to assemble a vehicle.
struct RunContext {
  const scenario::Scenario& scenario;  ///< if it has phases, a failed plan fails only its phase
  const Registry& registry;
  const WorldModel& world;
  physics::PhysicsWorld& physics;
  SignalBus& bus;
  Scheduler& scheduler;
  FileShelf* shelf;  ///< null: none
  /// Of the run: files of jobs and autopilots. Empty if it has neither.
  std::filesystem::path products;
  bool is_rehearsal;  ///< no job runs and no firmware starts
  /// All vehicles, as cameras see them; for the first step and later.
  std::function<VehicleScene&()> vehicles;
  std::function<void(Event::Level, const std::string& source, const std::string& text)> emit;
};

/// Products that a phase of a mission passes to its vehicle.
struct PhaseHandover {
  std::shared_ptr<const RowMap> map;        ///< replaces its `map`; null: keeps that
  std::shared_ptr<const PlannedPath> plan;  ///< replaces its planner's plan; null: keeps that
};

/// Parts of a vehicle in one phase, and their signals that the runtime reads and writes. Parts that
/// the scenario does not have are null. Not movable: parts point to the map.
struct VehicleParts {
  VehicleParts() = default;
  VehicleParts(const VehicleParts&) = delete;

  /// The vehicle's map. @param world  of the run
  const RowMap& map(const WorldModel& world) const { return own_map ? *own_map : *world.rows; }

  std::shared_ptr<const RowMap> own_map;  ///< null: the world's rows
  std::optional<MapGround> map_ground;    ///< if that map has a terrain
  std::vector<std::unique_ptr<Sensor>> sensors;
  std::vector<SensorMounting> mountings;  ///< of those sensors that have one
  std::unique_ptr<Estimator> estimator;
  std::vector<std::unique_ptr<Estimator>> observers;
  std::unique_ptr<Planner> planner;
  std::unique_ptr<Guidance> guidance;
  std::unique_ptr<Controller> controller;  ///< or autopilot
  std::vector<const MayFail*> may_fail;    ///< guidance and controller, if they can fail
  std::vector<std::pair<std::string, std::unique_ptr<Payload>>> payloads;
  std::vector<std::unique_ptr<Metric>> metrics;

  SignalWriter<LineList> map_edges;  ///< of the own map, if that has row meshes
  SignalReader<Odometry> estimate;   ///< for the planner
  SignalWriter<PlannedPath> plan;
  SignalWriter<LineList> tree;
  SignalReader<NamedValues> actuators;
  std::vector<std::string> diagnostics;  ///< signals that are recorded, but not in the digest
  std::vector<int> tasks;                ///< of the scheduler, while the parts run
};

/// Ticks of the runtime itself that are scheduled among those of the parts.
struct RuntimeTicks {
  std::function<void(Time)> plan, actuate;
};

class VehicleAssembly {
 public:
  /// @param parts  empty; all arguments outlive the assembly
  VehicleAssembly(const scenario::VehicleConfig& config, const RunContext& run,
                  const Vehicle& vehicle, VehicleParts& parts)
      : config_(config), run_(run), vehicle_(vehicle), parts_(parts) {}

  /// Builds and connects everything. @param begin  of the tasks; if absent, nothing is scheduled
  /// @throws ConfigError
  void build(const PhaseHandover& handover, std::optional<Time> begin, RuntimeTicks ticks);
  /// Only map and planner, unconnected. @param map  null: the vehicle's own
  /// @pre the scenario has a planner  @throws ConfigError
  std::unique_ptr<Planner> build_planner(std::shared_ptr<const RowMap> map);

 private:
  template <class Context>
  Context context(const std::string& part, double rate_Hz) const;
  ControllerContext controller_context(const std::string& part, double rate_Hz) const;
  EstimatorContext estimator_context(const std::string& part, double rate_Hz) const;
  PlannerContext planner_context() const;
  const RowMap& map() const { return parts_.map(run_.world); }
  double control_rate_Hz() const;
  /// The part's own rate; without one the controller's. Hz
  double rate_of(const scenario::PartConfig& part) const;
  void add_stepped(Stage stage, const std::string& part, const scenario::PartConfig& config,
                   double rate_Hz, SteppedPart& stepped,
                   std::map<std::string, std::string> written_as = {});
  void schedule(Stage stage, const std::string& part, Duration period, Duration offset,
                std::function<void(Time)> run);
  void take_map(std::shared_ptr<const RowMap> map);
  void add_sensors();
  void add_estimator();
  void add_observers();
  void add_planner(bool has_plan);
  void add_guidance();
  void add_controller(bool has_plan);
  void add_autopilot();
  /// What the controller or autopilot writes is applied after it.
  void schedule_actuators(double rate_Hz);
  void add_payloads();
  void add_metrics();
  /// @throws ConfigError with the part that reads a plan, if no planner writes one
  void refuse_a_missing_plan() const;
  void note_if_it_may_fail(const SteppedPart* part);
  /// Parameters of a metric. A metric that judges pictures gets the vehicle's camera if there is
  /// exactly one.
  ParameterSet parameters_of(const scenario::NamedPart& metric) const;

  const scenario::VehicleConfig& config_;
  const RunContext& run_;
  const Vehicle& vehicle_;
  VehicleParts& parts_;
  std::optional<Time> begin_;
  RuntimeTicks ticks_;
};

/// Builds the vehicle and places it at its start. @throws ConfigError
std::unique_ptr<Vehicle> make_placed_vehicle(const scenario::VehicleConfig& config,
                                             const RunContext& run);

/// Wraps a part's tick: turns exceptions that it throws, and NaN that it writes, into a
/// SimulationError with the part's name. A ConfigError at time 0 stays one, with the part's place
/// in the scenario: it is bad input. Call after the part has connected: only then the bus knows the
/// signals that it writes.
std::function<void(Time)> guarded(const SignalBus& bus, const std::string& part,
                                  const scenario::PartConfig& config,
                                  std::function<void(Time)> step);

}  // namespace vinerow
