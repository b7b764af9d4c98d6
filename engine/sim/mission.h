#pragma once
/// Execution of a mission, a graph of phases: starts and ends phases, passes their products on and
/// reports their outcomes.
///
/// A phase starts at the first instant at which every phase in its `after` has succeeded. It
/// succeeds when its job is done, or every vehicle's controller has finished, and its criteria are
/// met. It fails after a crash, at its timeout, or without a plan or product. A phase is blocked if
/// a phase in its `after` did not succeed.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/job.h"
#include "engine/api/messages/commands.h"
#include "engine/sim/phase_report.h"
#include "engine/sim/picture_collector.h"
#include "engine/sim/vehicle_runtime.h"
#include "engine/sim/weather_watch.h"

namespace vinerow {

class Mission {
 public:
  /// Builds the jobs and rehearses every vehicle, to find configuration errors before the run.
  /// @param run,vehicles  outlive the mission
  /// @param products  folder for the jobs' files, with one subfolder "<phase>" for each job
  /// @throws ConfigError
  Mission(const RunContext& run, const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles,
          std::filesystem::path products);

  /// Updates all phases; called at every instant, before anything else runs.
  /// @throws SimulationError
  void advance(Time now);
  /// Ends the mission with the run: running phases fail, waiting phases are "not started".
  /// @param reason  a sentence
  void close(Time now, const std::string& reason);
  /// Fails the phase in which a vehicle works, for a reason outside the mission.
  void fail_phase_of(const std::string& vehicle, Time now, const std::string& reason);

  /// No phase runs or will start.
  bool over() const;
  bool succeeded() const;
  const std::vector<PhaseReport>& reports() const { return reports_; }

 private:
  struct Phase {
    const scenario::PhaseConfig* config;
    std::unique_ptr<Job> job;
    std::filesystem::path folder;
    std::vector<VehicleRuntime*> vehicles;
    std::vector<PictureCollector> cameras;
    std::unique_ptr<WeatherWatch> weather;
    std::optional<Time> job_end;
    std::string job_failure;
  };

  /// Names what runs now to a profile, for the work that belongs to no vehicle.
  void note_phases() const;
  void build_job(Phase& phase);
  /// @param metrics  of the phase's vehicles, by vehicle and name; the values are ignored
  /// @throws ConfigError as check_criteria (judge.h)
  void check_criteria_of(const Phase& phase,
                         std::map<std::string, std::map<std::string, double>> metrics) const;
  void rehearse();
  bool step_all(Time now);
  void wait(std::size_t i, Time now);
  void begin(std::size_t i, Time now);
  void start_vehicles(std::size_t i, Time now);
  void run_job(std::size_t i, Time now);
  void watch(std::size_t i, Time now);
  void finish(std::size_t i, Time now);
  void fail(std::size_t i, Time now, const std::string& reason);
  void settle(std::size_t i, Time now, PhaseState state, const std::string& reason);
  void judge_phase(std::size_t i);
  void abort(std::size_t failed, Time now);
  void write_states(Time now);
  std::map<std::string, Product> inputs_of(std::size_t i) const;
  std::size_t index_of(const std::string& name) const;
  Result<PlannedPath> plan_for(const std::string& vehicle, std::shared_ptr<const RowMap> map);

  RunContext run_;
  const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles_;
  std::filesystem::path products_;
  std::vector<Phase> phases_;
  std::vector<PhaseReport> reports_;
  SignalWriter<NamedValues> states_writer_;
  NamedValues states_;
};

}  // namespace vinerow
