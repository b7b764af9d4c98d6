#pragma once
/// A complete run with its files: log.mcap, events.jsonl, scenario.resolved.yaml, frames/*.png,
/// canopy/*.json, summary.json, junit.xml.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/run/folder_lock.h"
#include "engine/run/run_driver.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/crash.h"
#include "engine/sim/phase_report.h"

namespace vinerow {
class RunShelf;
}

namespace vinerow::run {

class RunProfile;

/// Exit status of `vinerow run` (docs/reference/exit_status.md).
enum class RunStatus { kAllMet = 0, kCriterionFailed = 1, kBadInput = 2, kBrokenOff = 3 };

struct Progress {
  double simulated_s = 0.0;
  double duration_s = 0.0;
  double wall_s = 0.0;
};

struct RunResult;

struct RunOptions {
  std::filesystem::path out;  ///< folder of the files; created; if empty, nothing is written
  bool log = true;
  bool pictures = true;
  bool measure_cost = true;           ///< computing time of each stage in summary.json
  std::shared_ptr<RunShelf> shelf;    ///< cache of worlds and file contents, shared with other runs
  RunProfile* profile = nullptr;      ///< recorded by this thread; in summary.json
  std::shared_ptr<RunDriver> driver;  ///< may be null: the run goes to its end as fast as it can
  std::function<void(const Progress&)> progress;  ///< called about five times a second of wall time
  /// Called every simulated quarter second and before each picture; true ends the run or the
  /// drawing.
  std::function<bool()> interrupted;
  /// Called when the verdict and all files but the pictures are written.
  std::function<void(const RunResult&)> judged;
  std::function<void(int done, int total)> picture_progress;
};

struct RunResult {
  RunStatus status = RunStatus::kAllMet;
  std::string error;  ///< one sentence for kBrokenOff and for crashes
  std::string digest;
  double simulated_s = 0.0;
  double wall_s = 0.0;  ///< of stepping, without building the world and drawing pictures
  bool finished = false;
  std::vector<CriterionResult> criteria;
  std::vector<Crash> crashes;  ///< any of them makes the status kCriterionFailed
  std::map<std::string, std::map<std::string, double>> metrics;
  std::map<std::string, std::map<std::string, double>> planning;  ///< numbers from planners
  std::vector<PhaseReport> phases;  ///< of a mission; any that did not succeed: kCriterionFailed
  std::vector<std::filesystem::path> canopy;  ///< files with the results of payloads
  std::vector<std::filesystem::path> pictures;
  std::string picture_note;  ///< reason for missing pictures, if some were requested
  /// File that could not be stored after the verdict, with the reason, e.g. a full disk. Does not
  /// change the verdict.
  std::string write_failure;
  /// Keeps other runs out of the folder while this result or a copy lives.
  std::shared_ptr<FolderLock> lock;

  double real_time_factor() const { return wall_s > 0.0 ? simulated_s / wall_s : 0.0; }
};

/// Makes the checks that run_scenario() makes before its first step, by the same code, and writes
/// nothing. It also computes the first instant, unless a mission begins with a job or a vehicle has
/// an autopilot. Without a mission it goes on until every planner has made its plan, at most 10
/// simulated seconds. In a mission, a failed plan only fails its phase.
/// @returns notes for people: those of the world, the warnings until then, and which planners have
/// no plan yet
/// @throws ConfigError, SimulationError as run_scenario()
std::vector<std::string> rehearse_run(const scenario::Scenario& scenario, const Registry& registry);

/// @throws ConfigError if the scenario is in lock-step: without a driver nobody would give it
///   commands
void check_runs_alone(const scenario::Scenario& scenario);

/// Runs a scenario and, if options.out names a folder, writes its files. Each file except log and
/// events exists completely or not at all. Verdict and summary are written before pictures are
/// drawn, and again afterwards.
/// @throws ConfigError on bad input found while building or planning, or if another run uses the
///   folder; WriteError if the run cannot start to write
RunResult run_scenario(const scenario::Scenario& scenario, const Registry& registry,
                       const RunOptions& options);

}  // namespace vinerow::run
