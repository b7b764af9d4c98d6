#pragma once
/// A whole run with its files: log.mcap, events.jsonl, scenario.resolved.yaml, frames/*.png,
/// summary.json.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/run/folder_lock.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/crash.h"
#include "engine/sim/phase_report.h"

namespace vinerow {
class RunShelf;
}

namespace vinerow::run {

/// Exit status of `vinerow run` (docs/contributing/architecture.md).
enum class RunStatus { kAllMet = 0, kCriterionFailed = 1, kBadInput = 2, kBrokenOff = 3 };

struct Progress {
  double simulated_s = 0.0;
  double duration_s = 0.0;
  double wall_s = 0.0;
};

struct RunResult;

struct RunOptions {
  std::filesystem::path out;  ///< folder of the files; created; empty: nothing is written
  bool log = true;
  bool pictures = true;
  bool measure_cost = true;         ///< computing time of each stage in summary.json
  std::shared_ptr<RunShelf> shelf;  ///< worlds and contents of files, shared with other runs
  std::function<void(const Progress&)> progress;  ///< called about five times a second of wall time
  /// Asked every simulated quarter second, where true ends the run, and before each picture, where
  /// it ends the drawing.
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
  double wall_s = 0.0;  ///< of stepping, without building the world and without pictures
  bool finished = false;
  std::vector<CriterionResult> criteria;
  std::vector<Crash> crashes;  ///< any of them makes the status kCriterionFailed
  std::map<std::string, std::map<std::string, double>> metrics;
  std::map<std::string, std::map<std::string, double>> planning;  ///< what planners counted
  std::vector<PhaseReport> phases;  ///< of a mission; any that did not succeed: kCriterionFailed
  std::vector<std::filesystem::path> canopy;  ///< what payloads did, a file each
  std::vector<std::filesystem::path> pictures;
  std::string picture_note;  ///< why there are no pictures or not all, if they were asked for
  /// What could not be stored after the verdict, and why: "the disk is full". Takes nothing from
  /// the verdict.
  std::string write_failure;
  /// Keeps other runs out of the folder while this result or a copy lives.
  std::shared_ptr<FolderLock> lock;

  double real_time_factor() const { return wall_s > 0.0 ? simulated_s / wall_s : 0.0; }
};

/// Refuses what run_scenario() would refuse before its first step, by the same code, and writes
/// nothing. Outside missions, where a plan that cannot be made fails its phase, it runs until every
/// planner has made its plan, at most 10 simulated seconds.
/// @returns notes for people: those of the world, and which planner has no plan yet
/// @throws ConfigError, SimulationError as run_scenario()
std::vector<std::string> rehearse_run(const scenario::Scenario& scenario, const Registry& registry);

/// Runs a scenario and, where options.out names a folder, writes its files; each of them, but log
/// and events, is there whole or not at all. Verdict and summary are written before pictures are
/// drawn, and once more behind them.
/// @throws ConfigError on bad input found while building or planning, or if another run has the
///   folder; WriteError where the run cannot even begin to write
RunResult run_scenario(const scenario::Scenario& scenario, const Registry& registry,
                       const RunOptions& options);

}  // namespace vinerow::run
