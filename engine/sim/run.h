#pragma once
/// A whole run with its files: log.mcap, events.jsonl, scenario.resolved.yaml, frames/*.png,
/// summary.json.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/io/scenario.h"
#include "engine/sim/crash.h"
#include "engine/sim/phase_report.h"

namespace vinerow {

/// Exit status of `vinerow run` (docs/architecture.md).
enum class RunStatus { kAllMet = 0, kCriterionFailed = 1, kBadInput = 2, kBrokenOff = 3 };

struct Progress {
  double simulated_s = 0.0;
  double duration_s = 0.0;
  double wall_s = 0.0;
};

struct RunOptions {
  std::filesystem::path out;  ///< folder of the files; created
  bool log = true;
  bool pictures = true;
  bool measure_cost = true;                       ///< computing time of each stage in summary.json
  std::function<void(const Progress&)> progress;  ///< called about five times a second of wall time
  std::function<bool()> interrupted;  ///< asked every simulated quarter second; true ends the run
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
  std::vector<PhaseReport> phases;  ///< of a mission; any that did not succeed: kCriterionFailed
  std::vector<std::filesystem::path> canopy;  ///< what payloads did, a file each
  std::vector<std::filesystem::path> pictures;
  std::string picture_note;  ///< why there are no pictures, if they were asked for

  double real_time_factor() const { return wall_s > 0.0 ? simulated_s / wall_s : 0.0; }
};

/// Runs a scenario and writes its files. @throws ConfigError on bad input found while building or
/// planning
RunResult run_scenario(const io::Scenario& scenario, const Registry& registry,
                       const RunOptions& options);

}  // namespace vinerow
