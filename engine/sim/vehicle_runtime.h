#pragma once
/// One vehicle of a run with its sensors, estimator, planner, guidance, controller, payloads and
/// metrics, wired and scheduled: for the whole run, or for each of the phases that it works in.

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

/// What the vehicle's assembly needs from the run.
struct RunContext {
  const scenario::Scenario& scenario;  ///< with phases: a plan that cannot be made fails its phase
  const Registry& registry;
  const WorldModel& world;
  physics::PhysicsWorld& physics;
  SignalBus& bus;
  Scheduler& scheduler;
  FileShelf* shelf;  ///< null: none
  std::function<void(Event::Level, const std::string& source, const std::string& text)> emit;
};

/// What a phase of a mission hands its vehicle beside the vehicle's own configuration.
struct PhaseHandover {
  std::shared_ptr<const RowMap> map;        ///< in place of its `map`; null: that
  std::shared_ptr<const PlannedPath> plan;  ///< in place of its planner's; null: that
};

class VehicleRuntime {
 public:
  /// Builds the vehicle and stands it in the physics world; nothing else runs yet.
  /// @param others  vehicles that stand there already; it is added to them
  /// @throws ConfigError
  VehicleRuntime(const scenario::VehicleConfig& config, const RunContext& run,
                 std::vector<StartBox>& others);

  /// Builds and connects its parts without letting them run, so that faults are found before the
  /// run. @throws ConfigError
  void rehearse(const PhaseHandover& handover) { assemble(handover, std::nullopt); }
  /// Builds its parts anew and lets them run from `now` on. @throws ConfigError
  void begin(Time now, const PhaseHandover& handover);
  /// Its parts run no more, and it is parked. What flies and has not landed is left to its
  /// controller. @param done  it has finished, or lies on the ground
  void end(bool done);
  /// Held fast where it is, switched off, until it begins: others can touch it and not push it.
  void park();
  /// Its parts run.
  bool at_work() const { return !tasks_.empty(); }
  /// It works no more and did not come to its end: crashed, or stopped on its way.
  bool stranded() const { return crash_.has_value() || stranded_; }
  /// How near another vehicle has come so far, for its metrics; infinite: none has.
  void tell_separation(double least_m) { least_separation_m_ = least_m; }
  /// Why no plan could be made; empty where one could. Only in missions: elsewhere that is an
  /// error.
  const std::string& plan_failure() const { return plan_failure_; }
  /// It is to plan and has neither a plan nor a reason why there is none.
  bool awaits_plan() const { return planner_ && at_work() && !planned_ && plan_failure_.empty(); }
  /// Plans from where it stands with a planner of its own. @param map  null: its own map
  Result<PlannedPath> plan_ahead(std::shared_ptr<const RowMap> map);

  const std::string& name() const { return config_.name; }
  const Vehicle& vehicle() const { return *vehicle_; }
  const Odometry& truth() const { return truth_; }
  /// Its controller has nothing left to do; without a controller always. Never after a crash.
  bool finished() const;
  bool has_controller() const { return controller_ != nullptr; }
  /// How it was wrecked, or why its controller gave up, if so.
  const std::optional<Crash>& crash() const { return crash_; }
  scenario::OnCrash on_crash() const { return config_.on_crash; }

  /// Looks at a value that comes from outside, if it is for its actuators. @throws ConfigError
  /// naming the actuators there are
  void check_command(const SignalBase& value) const;

  /// Reads the bodies and writes "truth". Called at every instant.
  void publish_truth(Time now);
  void before_physics(Time now, Duration step) {
    if (!parked_) vehicle_->before_physics(now, step);
  }
  /// Advances the vehicle and checks that its state is finite and inside the envelope. @throws
  /// SimulationError
  void after_physics(Time now, Duration step);

  /// Of the last phase it worked in; not measured (NaN) where it never began.
  std::map<std::string, double> metric_results() const;
  const std::vector<std::pair<std::string, std::unique_ptr<Payload>>>& payloads() const {
    return payloads_;
  }
  /// Where its sensors sit, of those that sit somewhere; empty where its parts were never built.
  const std::vector<SensorMounting>& mountings() const { return mountings_; }
  /// What the planner told of its work; empty without planner or report.
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
  /// @param begin  absent: nothing is scheduled
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
  /// @throws ConfigError naming who reads a plan that no planner writes
  void refuse_a_missing_plan() const;
  void add_metrics();
  void note_if_it_may_fail(const SteppedPart* part);
  /// A metric's; one that judges pictures is told the vehicle's camera where it has just one.
  ParameterSet parameters_of(const scenario::NamedPart& metric) const;
  void publish_diagnostics(Time now);
  void try_to_plan(Time now);
  void actuate(Time now);
  void watch_contacts(Time now);
  /// Outside the ground a vehicle falls for ever. @throws SimulationError
  void demand_ground(Time now, const Pose& X_WB) const;
  void watch_crash(Time now);
  /// Of a vehicle that a controller drives.
  void watch_progress(Time now);
  double control_rate_Hz() const;
  /// Runs a part's tick; turns what it throws and the NaN it writes into a SimulationError with a
  /// name.
  std::function<void(Time)> guarded(const std::string& part, const std::string& type,
                                    std::function<void(Time)> step);

  scenario::VehicleConfig config_;
  RunContext run_;
  std::unique_ptr<Vehicle> vehicle_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  std::shared_ptr<const RowMap> own_map_;  ///< null: the world's rows
  std::optional<MapGround> map_ground_;    ///< where that map has a terrain
  std::unique_ptr<Estimator> estimator_;
  std::vector<std::unique_ptr<Estimator>> observers_;
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<Guidance> guidance_;
  std::unique_ptr<Controller> controller_;
  std::vector<const MayFail*> may_fail_;  ///< of guidance and controller those that can
  std::vector<std::pair<std::string, std::unique_ptr<Payload>>> payloads_;
  std::vector<NamedMetric> metrics_;
  std::vector<SensorMounting> mountings_;
  std::map<std::string, double> plan_numbers_;

  SignalWriter<Odometry> truth_writer_;
  SignalWriter<LinkPoses> links_writer_;
  SignalWriter<NamedValues> contacts_writer_;
  SignalWriter<LineList> map_edges_writer_;  ///< of its own map, where that has row meshes
  SignalWriter<PlannedPath> plan_writer_;
  SignalWriter<LineList> tree_writer_;
  SignalReader<Odometry> estimate_;
  SignalReader<NamedValues> actuators_;
  std::uint64_t actuators_seen_ = 0;
  std::vector<std::string> actuator_names_;  // as last written
  std::vector<int> actuator_index_;          // of each of them
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
  std::optional<double> least_separation_m_;
  bool worked_ = false;  ///< has begun at least once
  bool map_edges_due_ = false;
  bool planned_ = false;
  std::string plan_failure_;
  bool said_finished_ = false;
  std::optional<Crash> crash_;
  std::optional<ProgressWatch> progress_;
  Time progress_seen_;
  std::vector<std::string> diagnostic_signals_;
};

}  // namespace vinerow
