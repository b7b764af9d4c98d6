#pragma once
/// One vehicle of a run with its sensors, estimator, planner, guidance, controller, payloads and
/// metrics, connected and scheduled for the whole run or for each phase in which it works.

#include <functional>
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
#include "engine/sim/crash.h"
#include "engine/sim/map_ground.h"
#include "engine/sim/progress_watch.h"
#include "engine/sim/scheduler.h"
#include "engine/sim/spawn.h"

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
  std::function<void(Event::Level, const std::string& source, const std::string& text)> emit;
};

/// Products that a phase of a mission passes to its vehicle.
struct PhaseHandover {
  std::shared_ptr<const RowMap> map;        ///< replaces its `map`; null: keeps that
  std::shared_ptr<const PlannedPath> plan;  ///< replaces its planner's plan; null: keeps that
};

class VehicleRuntime {
 public:
  /// Builds the vehicle and places it in the physics world; its parts do not run yet.
  /// @param others  vehicles that are already placed; this one is added to them
  /// @throws ConfigError
  VehicleRuntime(const scenario::VehicleConfig& config, const RunContext& run,
                 std::vector<StartBox>& others);

  /// Builds and connects its parts without running them, to find configuration errors before the
  /// run. @throws ConfigError
  void rehearse(const PhaseHandover& handover) { assemble(handover, std::nullopt); }
  /// Rebuilds its parts and runs them from `now` on. @throws ConfigError
  void begin(Time now, const PhaseHandover& handover);
  /// Stops its parts and parks it. If it flies and is not done, its parts keep running instead.
  /// @param done  it has finished or crashed
  void end(bool done);
  /// Powers it off and fixes it in place until begin(). Other vehicles can touch it but not push
  /// it.
  void park();
  /// Its parts run.
  bool at_work() const { return !tasks_.empty(); }
  /// It crashed, or its work ended before it had finished.
  bool stranded() const { return crash_.has_value() || stranded_; }
  /// Sets the smallest distance to another vehicle so far, for its metrics; infinite if there was
  /// none.
  void set_separation(double min_m) { min_separation_m_ = min_m; }
  /// Reason why no plan could be made, else empty. Only in missions; in other runs a failed plan
  /// throws.
  const std::string& plan_failure() const { return plan_failure_; }
  /// Its planner has neither made a plan nor failed yet.
  bool awaits_plan() const { return planner_ && at_work() && !planned_ && plan_failure_.empty(); }
  /// Plans from its present pose with a separate planner. @param map  null: its own map
  Result<PlannedPath> plan_ahead(std::shared_ptr<const RowMap> map);

  const std::string& name() const { return config_.name; }
  const Vehicle& vehicle() const { return *vehicle_; }
  const Odometry& truth() const { return truth_; }
  /// Its controller has nothing left to do. Always true without a controller, never after a crash.
  bool finished() const;
  bool has_controller() const { return controller_ != nullptr; }
  /// How it crashed or got stuck, or why its guidance or controller gave up, if so.
  const std::optional<Crash>& crash() const { return crash_; }
  scenario::OnCrash on_crash() const { return config_.on_crash; }

  /// Checks a value from outside if it is for its actuators. @throws ConfigError with the
  /// actuators that exist
  void check_command(const SignalBase& value) const;

  /// Reads the bodies and writes "truth"; called at every instant.
  void publish_truth(Time now);
  void before_physics(Time now, Duration step) {
    if (!parked_) vehicle_->before_physics(now, step);
  }
  /// Advances the vehicle and checks that its state is finite and inside the envelope. @throws
  /// SimulationError
  void after_physics(Time now, Duration step);

  /// Metrics of the last phase in which it worked; not measured (NaN) if it never began.
  std::map<std::string, double> metric_results() const;
  const std::vector<std::pair<std::string, std::unique_ptr<Payload>>>& payloads() const {
    return payloads_;
  }
  /// Mountings of those sensors that have one; empty if its parts were never built.
  const std::vector<SensorMounting>& mountings() const { return mountings_; }
  /// Numbers that the planner reported; empty without planner or report.
  const std::map<std::string, double>& plan_numbers() const { return plan_numbers_; }
  /// Names of the signals that are diagnostics: recorded, but not part of the digest.
  const std::vector<std::string>& diagnostic_signals() const { return diagnostic_signals_; }

 private:
  struct NamedMetric {
    std::string name;
    std::unique_ptr<Metric> metric;
  };

  template <class Context>
  Context context(const std::string& part, double rate_Hz) const;
  void add_stepped(Stage stage, const std::string& part, const std::string& type, double rate_Hz,
                   SteppedPart& stepped, std::map<std::string, std::string> written_as = {});
  /// @param begin  if absent, nothing is scheduled
  void assemble(const PhaseHandover& handover, std::optional<Time> begin);
  void take_down();
  void unpark();
  void schedule(Stage stage, const std::string& part, Duration period, Duration offset,
                std::function<void(Time)> run);
  void add_diagnostic(const std::string& signal);
  std::shared_ptr<const RowMap> make_map() const;
  void take_map(std::shared_ptr<const RowMap> map);
  void show_map();
  const RowMap& map() const { return own_map_ ? *own_map_ : *run_.world.rows; }
  PlannerContext planner_context() const;
  void add_sensors();
  void add_estimator();
  void add_observers();
  EstimatorContext estimator_context(const std::string& part, double rate_Hz) const;
  void add_planner();
  void add_controller();
  void add_actuators(Duration period);
  void add_payloads();
  /// @throws ConfigError with the part that reads a plan, if no planner writes one
  void refuse_a_missing_plan() const;
  void add_metrics();
  void note_if_it_may_fail(const SteppedPart* part);
  /// Parameters of a metric. A metric that judges pictures gets the vehicle's camera if there is
  /// exactly one.
  ParameterSet parameters_of(const scenario::NamedPart& metric) const;
  void publish_diagnostics(Time now);
  void try_to_plan(Time now);
  void actuate(Time now);
  void watch_contacts(Time now);
  /// Outside the ground a vehicle would fall forever. @throws SimulationError
  void demand_ground(Time now, const Pose& X_WB) const;
  void watch_crash(Time now);
  /// Only for vehicles with a controller.
  void watch_progress(Time now);
  double control_rate_Hz() const;
  /// Wraps a part's tick: turns exceptions that it throws, and NaN that it writes, into a
  /// SimulationError with the part's name.
  std::function<void(Time)> guarded(const std::string& part, const std::string& type,
                                    std::function<void(Time)> step);

  scenario::VehicleConfig config_;
  RunContext run_;
  std::unique_ptr<Vehicle> vehicle_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  std::shared_ptr<const RowMap> own_map_;  ///< null: the world's rows
  std::optional<MapGround> map_ground_;    ///< if that map has a terrain
  std::unique_ptr<Estimator> estimator_;
  std::vector<std::unique_ptr<Estimator>> observers_;
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<Guidance> guidance_;
  std::unique_ptr<Controller> controller_;
  std::vector<const MayFail*> may_fail_;  ///< guidance and controller, if they can fail
  std::vector<std::pair<std::string, std::unique_ptr<Payload>>> payloads_;
  std::vector<NamedMetric> metrics_;
  std::vector<SensorMounting> mountings_;
  std::map<std::string, double> plan_numbers_;

  SignalWriter<Odometry> truth_writer_;
  SignalWriter<LinkPoses> links_writer_;
  SignalWriter<NamedValues> contacts_writer_;
  SignalWriter<LineList> map_edges_writer_;  ///< of its own map, if that has row meshes
  SignalWriter<PlannedPath> plan_writer_;
  SignalWriter<LineList> tree_writer_;
  SignalReader<Odometry> estimate_;
  SignalReader<NamedValues> actuators_;
  std::uint64_t actuators_seen_ = 0;
  std::vector<std::string> actuator_names_;  // as last written
  std::vector<int> actuator_index_;          // of each name
  std::vector<double> actuator_values_;
  Odometry truth_;
  LinkPoses links_;
  NamedValues contacts_;
  Time last_contact_{-1'000'000'000};
  int first_body_ = 0;
  int end_body_ = 0;
  PhaseHandover handover_;
  std::optional<Time> begin_;  ///< of the parts that are built; absent while rehearsing
  std::vector<int> tasks_;     ///< of the scheduler, while the parts run
  bool parked_ = false;
  std::vector<int> held_bodies_;
  bool stranded_ = false;
  std::optional<double> min_separation_m_;
  bool worked_ = false;  ///< has begun at least once
  bool map_edges_due_ = false;
  bool planned_ = false;
  std::string plan_failure_;
  bool has_reported_finished_ = false;
  std::optional<Crash> crash_;
  std::optional<ProgressWatch> progress_;
  Time progress_seen_;
  std::vector<std::string> diagnostic_signals_;
};

}  // namespace vinerow
