#pragma once
/// What a run left in its folder, read and checked: the material of the report.

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/world_model.h"
#include "engine/record/log_reader.h"
#include "engine/scenario/scenario.h"

namespace vinerow::tools::report {

using Json = nlohmann::ordered_json;

struct RunFolder {
  std::filesystem::path path;
  Json summary;
  std::string resolved_yaml;                     ///< "" where the run left none
  std::optional<scenario::Scenario> scenario;    ///< of resolved_yaml
  std::unique_ptr<WorldModel> world;             ///< null where the scenario is not known
  std::vector<std::unique_ptr<Vehicle>> models;  ///< of the scenario's vehicles, in its order
  std::unique_ptr<record::LogReader> log;        ///< null where the run wrote none
  std::vector<std::filesystem::path> frames;     ///< frames/*.png, by name
  std::vector<std::string> vehicles;             ///< names, in the scenario's order

  /// Text of the summary's key, "" where it has none.
  std::string text(const char* key) const;
  /// Number of the summary's key, NaN where it has none.
  double number(const char* key) const;
  /// summary.metrics.<vehicle>.<metric>, NaN where it was not measured.
  double metric(const std::string& vehicle, const std::string& name) const;
  /// All simulated time of the run, s.
  double end_s() const;
};

/// @throws ConfigError "runs/x: holds no summary.json, so it is no folder of a run" | "...: is not
/// JSON: ..." | "runs/x/log.mcap: is of scenario 'a' (seed 1), summary.json beside it of 'b' (seed
/// 1)"
RunFolder read_run_folder(const std::filesystem::path& folder, const Registry& registry);

/// Content of a JSON value that may be null or no number: NaN then.
double number_of(const Json& value);

/// A list in `json`; an empty one where the key is absent.
const Json& list_in(const Json& json, const char* key);

}  // namespace vinerow::tools::report
