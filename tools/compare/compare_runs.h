#pragma once
/// Comparison of runs by their summary.json.

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vinerow::tools {

/// A metric in every run; NaN if a run did not measure it.
struct ComparedMetric {
  std::string name;  ///< "rover.cross_track_rms_m"
  std::vector<double> values;
  bool differs = false;  ///< differs by more than the tolerance, or is missing in a run
};

enum class CriterionState { kAbsent, kMet, kFailed };

struct ComparedCriterion {
  std::string name;  ///< "rover.cross_track_rms_m <= 0.05", or of a phase
  std::vector<CriterionState> states;
};

struct ComparedRun {
  std::string folder, scenario, status, digest;
  std::string seed;
  int exit_status = 0;
};

/// Result of a comparison. The first run is the reference.
struct RunComparison {
  std::vector<ComparedRun> runs;
  std::vector<ComparedMetric> metrics;
  std::vector<ComparedCriterion> criteria;
  /// Sentences on criteria and phases that the first run met and a later one did not, and on runs
  /// that broke off.
  std::vector<std::string> regressions;
  std::size_t differences = 0;  ///< metrics that differ
};

/// @param tolerance  two numbers are equal if they differ by at most this share of the larger one
/// @throws ConfigError "runs/x/summary.json: has no object 'metrics', ..."
RunComparison compare_runs(const std::vector<std::filesystem::path>& folders, double tolerance);

/// @param all  also metrics that do not differ
std::string comparison_text(const RunComparison& comparison, bool all);
nlohmann::ordered_json comparison_json(const RunComparison& comparison);

}  // namespace vinerow::tools
