#pragma once
/// Content of a run's folder, read and checked: the material of the report.

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

namespace vinerow {
class RunShelf;
}

namespace vinerow::tools::report {

using Json = nlohmann::ordered_json;

struct RunFolder {
  std::filesystem::path path;
  Json summary;
  std::string resolved_yaml;                     ///< "" if the run left none
  std::optional<scenario::Scenario> scenario;    ///< of resolved_yaml
  std::shared_ptr<const WorldModel> world;       ///< null if the scenario is unknown
  std::vector<std::unique_ptr<Vehicle>> models;  ///< of the scenario's vehicles, in its order
  std::unique_ptr<record::LogReader> log;        ///< null if the run wrote none
  std::vector<std::filesystem::path> frames;     ///< frames/*.png, by name
  std::vector<std::string> vehicles;             ///< names, in the scenario's order

  /// Text of a key of the summary; "" if absent.
  std::string text(const char* key) const;
  /// Number of a key of the summary; NaN if absent.
  double number(const char* key) const;
  /// summary.metrics.<vehicle>.<metric>; NaN if it was not measured.
  double metric(const std::string& vehicle, const std::string& name) const;
  /// Total simulated time of the run, s.
  double end_s() const;
};

/// @throws ConfigError "runs/x: contains no summary.json, so it is not the folder of a run" | "...:
/// is not JSON, ..." | "runs/x/log.mcap: belongs to scenario 'a' (seed 1), but summary.json next to
/// it to 'b' (seed 1)"
/// @param shelf  has the world, if the run has just ended; may be null
RunFolder read_run_folder(const std::filesystem::path& folder, const Registry& registry,
                          RunShelf* shelf);

/// Files of a folder, by name; empty if there is no such folder. @param extension  ".png"
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                            const char* extension);

/// Number in a JSON value; NaN if it is null or not a number.
double number_of(const Json& value);

/// List in `json`; empty if the key is absent.
const Json& list_in(const Json& json, const char* key);

}  // namespace vinerow::tools::report
