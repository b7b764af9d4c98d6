#pragma once
/// A mission as a graph of phases: begins those whose turn it is, ends those that are done, hands
/// their products on, and says what became of each.
///
/// A phase begins at the first instant at which every phase it is `after` has succeeded. It has
/// succeeded when its job is done, or every vehicle's controller has finished, and its criteria are
/// met; it has failed after a crash, at its timeout, without a plan or a product. What is `after`
/// a phase that did not succeed is blocked.

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
  /// Builds the jobs and rehearses every vehicle, so that faults of either are found before the
  /// run. @param run,vehicles  outlive the mission
  /// @param products  folder for the jobs' files, "<phase>" below it each
  /// @throws ConfigError
  Mission(const RunContext& run, const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles,
          std::filesystem::path products);

  /// Looks at all phases; called at every instant, before anything else runs.
  /// @throws SimulationError
  void advance(Time now);
  /// The run ends here: what runs has failed, what waits has not started. @param reason  a sentence
  void close(Time now, const std::string& reason);
  /// A phase of vehicles fails from outside. @param vehicle  that works in it
  void fail_phase_of(const std::string& vehicle, Time now, const std::string& reason);

  /// No phase runs or will.
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

  void build_job(Phase& phase);
  void rehearse();
  bool step_all(Time now);
  void wait(std::size_t i, Time now);
  void begin(std::size_t i, Time now);
  void begin_vehicles(std::size_t i, Time now);
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
