#pragma once
/// A study file: one scenario, what varies in it, and what is kept of each run.
///
///   vinerow_study: 1
///   scenario: paper_b_field.yaml
///   factors:
///     lookahead: {key: rover.controller.lookahead_m, values: [0.5, 1, 2]}
///     spacing: {key: rover.planner.waypoint_spacing_m, from: 0.5, to: 2.5, step: 0.5}
///   seeds: 10
///
/// Guide: docs/guides/studies.md.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scenario/scenario.h"

namespace vinerow::scenario {

/// One value of a factor: what it sets, and how tables show it.
struct FactorLevel {
  std::vector<OverrideValue> values;
  std::vector<std::string> texts;  ///< one for each of the factor's columns
};

/// What varies: a parameter, several at a time, whole parts, or a sample of a region.
struct Factor {
  std::string name;
  std::vector<std::string> columns;  ///< in tables: the factor's name, or its key paths
  std::vector<FactorLevel> levels;   ///< not empty
  io::SourceMark where;
};

/// More seeds are run for a setting until the confidence interval of a metric's mean is narrow.
struct StopRule {
  std::string metric;
  double half_width = 0.0;  ///< in the metric's unit, or a share of the mean where `relative`
  bool relative = false;
  double confidence = 0.95;
  int at_least = 5;  ///< seeds
};

struct CellBudget {
  double time_s = 0.0;     ///< of wall clock; 0: unlimited
  double memory_MB = 0.0;  ///< resident; 0: unlimited
};

/// Which runs leave their files.
enum class KeepRuns {
  kNothing,
  kSummary,  ///< summary.json, events.jsonl and what goes with them
  kLog,      ///< the log too
  kFailed    ///< as kLog, of runs that did not meet their criteria or broke off
};

/// A column computed from others.
struct DerivedColumn {
  std::string name;
  std::string expression;
  io::SourceMark where;
};

struct Study {
  std::string name;
  std::string description;
  std::filesystem::path file;      ///< absolute
  std::filesystem::path scenario;  ///< absolute
  std::vector<OverrideValue> set;  ///< of every cell
  std::vector<Factor> factors;     ///< in file order
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> metrics;  ///< to keep; empty: all
  std::vector<DerivedColumn> derived;
  std::optional<StopRule> stop;
  CellBudget budget;
  KeepRuns keep = KeepRuns::kNothing;
  io::SourceMark stop_mark, metrics_mark;
};

/// Reads and checks a study as far as that needs no parts: its own keys, factors, counts. Whether
/// key paths and values fit the scenario is known once a scenario is loaded with them.
/// @throws ConfigError "study.yaml:7: ..." in one sentence
Study load_study(const std::filesystem::path& file);

/// JSON Schema (draft 2020-12) of study files.
std::string study_json_schema();

}  // namespace vinerow::scenario
