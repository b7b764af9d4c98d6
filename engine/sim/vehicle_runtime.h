#pragma once
/// One vehicle of a run with its sensors, estimator, planner, guidance, controller and metrics,
/// wired and scheduled.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/io/scenario.h"
#include "engine/physics/physics_world.h"
#include "engine/sim/crash.h"
#include "engine/sim/map_ground.h"
#include "engine/sim/scheduler.h"

namespace vinerow {

/// What the vehicle's assembly needs from the run.
struct RunContext {
  const io::Scenario& scenario;
  const Registry& registry;
  const WorldModel& world;
  physics::PhysicsWorld& physics;
  SignalBus& bus;
  Scheduler& scheduler;
  std::function<void(Event::Level, const std::string& source, const std::string& text)> emit;
};

class VehicleRuntime {
 public:
  /// Builds the vehicle, puts it into the physics world, connects and schedules its parts. @throws
  /// ConfigError
  VehicleRuntime(const io::VehicleConfig& config, const RunContext& run);

  const std::string& name() const { return config_.name; }
  const Vehicle& vehicle() const { return *vehicle_; }
  const Odometry& truth() const { return truth_; }
  /// Its controller has nothing left to do; without a controller always. Never after a crash.
  bool finished() const { return !crash_ && (controller_ == nullptr || controller_->finished()); }
  bool has_controller() const { return controller_ != nullptr; }
  /// How it was wrecked, if it was.
  const std::optional<Crash>& crash() const { return crash_; }
  io::OnCrash on_crash() const { return config_.on_crash; }

  /// Reads the bodies and writes "truth". Called at every instant.
  void publish_truth(Time now);
  void before_physics(Time now, Duration step) { vehicle_->before_physics(now, step); }
  /// Advances the vehicle and checks that its state is finite and inside the envelope. @throws
  /// SimulationError
  void after_physics(Time now, Duration step);

  std::map<std::string, double> metric_results() const;
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
  void make_map();
  const RowMap& map() const { return own_map_ ? *own_map_ : run_.world.rows; }
  void add_sensors();
  void add_estimator();
  void add_observers();
  EstimatorContext estimator_context(const std::string& part, double rate_Hz) const;
  void add_planner();
  void add_controller();
  /// @throws ConfigError naming who reads a plan that no planner writes
  void refuse_a_missing_plan() const;
  void add_metrics();
  void publish_diagnostics(Time now);
  void try_to_plan(Time now);
  void actuate(Time now);
  void watch_contacts(Time now);
  void watch_crash(Time now);
  double control_rate_Hz() const;
  /// Runs a part's tick; turns what it throws and the NaN it writes into a SimulationError with a
  /// name.
  std::function<void(Time)> guarded(const std::string& part, const std::string& type,
                                    std::function<void(Time)> step);

  io::VehicleConfig config_;
  RunContext run_;
  std::unique_ptr<Vehicle> vehicle_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  std::unique_ptr<RowMap> own_map_;      ///< null: the world's rows
  std::optional<MapGround> map_ground_;  ///< where that map has a terrain
  std::unique_ptr<Estimator> estimator_;
  std::vector<std::unique_ptr<Estimator>> observers_;
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<Guidance> guidance_;
  std::unique_ptr<Controller> controller_;
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
  std::vector<int> actuator_index_;  // of each name the controller writes
  std::vector<double> actuator_values_;
  Odometry truth_;
  LinkPoses links_;
  NamedValues contacts_;
  Time last_contact_{-1'000'000'000};
  int first_body_ = 0;
  int end_body_ = 0;
  bool planned_ = false;
  bool said_finished_ = false;
  std::optional<Crash> crash_;
  std::vector<std::string> diagnostic_signals_;
};

/// Pose of a vehicle at the start, standing on the ground.
/// @throws ConfigError naming what the world has, if the alley or spawn point is unknown
Pose find_spawn_pose(const io::SpawnConfig& spawn, const WorldModel& world, const SceneQuery& scene,
                     const std::string& vehicle, double height_above_ground_m);

}  // namespace vinerow
