#pragma once
/// Study file: one scenario, its varied parameters, and the results kept of each run.
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

/// One level of a factor: the values that it sets, and their texts in tables.
struct FactorLevel {
  std::vector<OverrideValue> values;
  std::vector<std::string> texts;  ///< one for each of the factor's columns
};

/// Varied quantity: a parameter, several parameters together, whole parts, or a sample of a region.
struct Factor {
  std::string name;
  std::vector<std::string> columns;  ///< of tables: the factor's name, or its key paths
  std::vector<FactorLevel> levels;   ///< not empty
  io::SourceMark where;
};

/// Stopping rule: seeds are added to a setting until the confidence interval of a metric's mean is
/// narrow enough.
struct StopRule {
  std::string metric;
  double half_width = 0.0;  ///< in the metric's unit, or a share of the mean if `relative`
  bool relative = false;
  double confidence = 0.95;
  int at_least = 5;  ///< seeds
};

struct CellBudget {
  double time_s = 0.0;     ///< of wall clock; 0: unlimited
  double memory_MB = 0.0;  ///< resident; 0: unlimited
};

/// Files to keep of each run.
enum class KeepRuns {
  kNothing,
  kSummary,  ///< summary.json, events.jsonl and similar small files
  kLog,      ///< also the log
  kFailed    ///< as kLog, for runs that missed their criteria or aborted
};

/// Which pictures of a data set go to training together: those of a cell, of a seed (the same
/// plants), or of a setting.
enum class SplitBy { kCell, kSeed, kSetting };

/// Formats and classes of things that a data set may have.
const std::vector<std::string>& dataset_formats();
const std::vector<std::string>& dataset_classes();

/// What `vinerow dataset` makes of the study's runs.
struct DatasetConfig {
  std::string camera;             ///< "rover/front"
  std::optional<double> every_s;  ///< between pictures; absent: the camera's rate
  std::optional<int> pictures;    ///< of a run, at most; absent: all
  std::vector<std::string> formats = {"coco", "yolo"};
  std::vector<std::string> classes = {"trunk", "post", "bunch", "fruit", "vehicle"};
  int min_pixels = 16;  ///< smaller things are not listed
  double validation_share = 0.2;
  double test_share = 0.0;
  SplitBy split_by = SplitBy::kSeed;
  std::string licence;  ///< of the data set, for its card; "": not stated
};

/// Column computed from other columns.
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
  std::vector<OverrideValue> set;  ///< applied to every cell
  std::vector<Factor> factors;     ///< in file order
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> metrics;  ///< metrics to keep; empty: all
  std::vector<DerivedColumn> derived;
  std::optional<StopRule> stop;
  CellBudget budget;
  KeepRuns keep = KeepRuns::kNothing;
  std::optional<DatasetConfig> dataset;
  io::SourceMark stop_mark, metrics_mark, dataset_mark;
};

/// Reads a study and checks its own keys, factors and counts. Key paths and values are checked
/// against the scenario only when the scenario is loaded with them.
/// @throws ConfigError "study.yaml:7: ..." in one sentence
Study load_study(const std::filesystem::path& file);

/// JSON Schema (draft 2020-12) of study files.
std::string study_json_schema();

}  // namespace vinerow::scenario
