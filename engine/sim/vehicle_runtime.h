#pragma once
/// One vehicle of a run: its parts work for the whole run or for each phase in which it works. It
/// writes the truth, plans, actuates and parks.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/sim/separation.h"
#include "engine/sim/spawn.h"
#include "engine/sim/vehicle_assembly.h"
#include "engine/sim/vehicle_watch.h"

namespace vinerow {

class VehicleRuntime {
 public:
  /// Builds the vehicle and places it in the physics world; its parts do not run yet.
  /// @param others  vehicles that are already placed; this one is added to them
  /// @throws ConfigError
  VehicleRuntime(const scenario::VehicleConfig& config, const RunContext& run,
                 std::vector<StartBox>& others);

  /// Builds and connects its parts without running them and checks what cameras and 3D scanners
  /// see from its start, to find configuration errors before the run. @throws ConfigError
  void rehearse(const PhaseHandover& handover);
  /// Rebuilds its parts and runs them from `now` on. @throws ConfigError
  void begin(Time now, const PhaseHandover& handover);
  /// Stops its parts and parks it. If it flies and is not done, its parts keep running instead.
  /// @param done  it has finished or crashed
  void end(bool done);
  /// Powers it off and fixes it in place until begin(). Other vehicles can touch it but not push
  /// it.
  void park();
  /// Its parts run.
  bool at_work() const { return !parts_->tasks.empty(); }
  /// It crashed, or its work ended before it had finished.
  bool stranded() const { return crash().has_value() || stranded_; }
  /// Adds the smallest distance to another vehicle to its metrics.
  /// @param separation  outlives it  @param index  of this vehicle there
  void measure_separation(const Separation& separation, int index) {
    separation_ = &separation;
    separation_index_ = index;
  }
  /// Reason why no plan could be made, else empty. Only in missions; in other runs a failed plan
  /// throws.
  const std::string& plan_failure() const { return plan_failure_; }
  /// Its planner has neither made a plan nor failed yet.
  bool awaits_plan() const {
    return parts_->planner && at_work() && !planned_ && plan_failure_.empty();
  }
  /// Plans from its present pose with a separate planner. @param map  null: its own map
  Result<PlannedPath> plan_ahead(std::shared_ptr<const RowMap> map) const;

  const std::string& name() const { return config_.name; }
  const Vehicle& vehicle() const { return *vehicle_; }
  /// Its map; without one of its own, the true rows. Valid until the vehicle's next phase begins.
  const RowMap& map() const { return parts_->map(run_.world); }
  const Odometry& truth() const { return truth_; }
  /// Its controller has nothing left to do. Always true without a controller, never after a crash.
  bool finished() const;
  bool has_controller() const { return parts_->controller != nullptr; }
  /// How it crashed or got stuck, or why its guidance or controller gave up, if so.
  const std::optional<Crash>& crash() const { return watch_.crash(); }
  /// Its task cannot be done, because of others (deadlock).
  void give_up(Time now, const std::string& reason) { watch_.give_up(now, reason); }
  scenario::OnCrash on_crash() const { return config_.on_crash; }

  /// Checks a value from outside if it is for its actuators. @throws ConfigError with the
  /// actuators that exist
  void check_command(const SignalBase& value) const;

  /// Reads the bodies and writes "truth"; called at every instant.
  void publish_truth(Time now);
  void before_physics(Time now, Duration step);
  /// Advances the vehicle and checks that its state is finite and inside the envelope. @throws
  /// SimulationError
  void after_physics(Time now, Duration step);

  /// Metrics of the last phase in which it worked; not measured (NaN) if it never began.
  std::map<std::string, double> metric_results() const;
  const std::vector<std::pair<std::string, std::unique_ptr<Payload>>>& payloads() const {
    return parts_->payloads;
  }
  /// Mountings of those sensors that have one; empty if its parts were never built.
  const std::vector<SensorMounting>& mountings() const { return parts_->mountings; }
  /// Numbers that the planner reported; empty without planner or report.
  const std::map<std::string, double>& plan_numbers() const { return plan_numbers_; }
  /// Names of the signals that are diagnostics: recorded, but not part of the digest.
  const std::vector<std::string>& diagnostic_signals() const { return diagnostic_signals_; }

 private:
  /// @param begin  if absent, nothing is scheduled
  void assemble(const PhaseHandover& handover, std::optional<Time> begin);
  void stop();
  void unpark();
  void publish_diagnostics(Time now);
  void try_to_plan(Time now);
  void actuate(Time now);
  /// Sets every actuator to 0, or to its limit nearest to 0.
  void actuate_zero();
  /// @param wanted  as the controller or a program outside wrote it
  /// @throws SimulationError, ConfigError if it does not fit the actuators
  /// Name of the part that commands the actuators.
  std::string driver() const;
  void take_actuators(Time now, const NamedValues& wanted);

  scenario::VehicleConfig config_;
  RunContext run_;
  int first_body_ = 0;
  std::unique_ptr<Vehicle> vehicle_;
  int end_body_ = 0;
  VehicleWatch watch_;
  std::unique_ptr<VehicleParts> parts_ = std::make_unique<VehicleParts>();

  SignalWriter<Odometry> truth_writer_;
  SignalWriter<LinkPoses> links_writer_;
  Odometry truth_;
  LinkPoses links_;
  std::vector<std::string> diagnostic_signals_;
  const Separation* separation_ = nullptr;
  int separation_index_ = 0;

  bool parked_ = false;
  std::vector<int> held_bodies_;
  bool stranded_ = false;
  bool worked_ = false;  ///< has begun at least once

  std::shared_ptr<const PlannedPath> given_plan_;
  bool map_edges_due_ = false;
  bool planned_ = false;
  std::string plan_failure_;
  std::map<std::string, double> plan_numbers_;

  std::uint64_t actuators_seen_ = 0;
  std::vector<std::string> actuator_names_;  ///< as last written
  std::vector<int> actuator_index_;          ///< of each name
  std::vector<double> actuator_values_;
  bool has_reported_finished_ = false;
};

}  // namespace vinerow
