#include "tools/report/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/playback/run_frames.h"
#include "engine/sim/run_shelf.h"

namespace vinerow::tools::report {
namespace {

namespace fs = std::filesystem;

Json read_summary(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  if (!fs::is_regular_file(file)) {
    throw ConfigError(fmt::format("{}: contains no summary.json, so it is not the folder of a run",
                                  folder.string()));
  }
  Json summary = Json::parse(read_bytes(file).value_or(""), nullptr, false);
  if (summary.is_discarded()) {
    throw ConfigError(
        fmt::format("{}: is not JSON, so the run's results cannot be read", file.string()));
  }
  for (const char* key : {"scenario", "status", "digest"}) {
    if (!summary.is_object() || !summary.contains(key) || !summary[key].is_string()) {
      throw ConfigError(fmt::format("{}: has no text '{}', so it is not the summary of a run",
                                    file.string(), key));
    }
  }
  return summary;
}

void open_log(RunFolder& run) {
  const fs::path file = run.path / "log.mcap";
  if (!fs::is_regular_file(file)) return;
  auto log = std::make_unique<record::LogReader>(file);
  const auto& log_metadata = log->info().metadata;
  const auto of = [&](const char* key) {
    const auto found = log_metadata.find(key);
    return found == log_metadata.end() ? std::string() : found->second;
  };
  const std::string seed = run.summary.contains("seed") ? run.summary["seed"].dump() : "";
  if (of("scenario") != run.text("scenario") || of("seed") != seed) {
    throw ConfigError(fmt::format(
        "{}: belongs to scenario '{}' (seed {}), but summary.json next to it to '{}' (seed {})",
        file.string(), of("scenario"), of("seed"), run.text("scenario"), seed));
  }
  run.log = std::move(log);
}

void read_scenario(RunFolder& run, const Registry& registry, RunShelf* shelf) {
  const fs::path file = run.path / "scenario.resolved.yaml";
  if (fs::is_regular_file(file)) {
    run.resolved_yaml = read_bytes(file).value_or("");
  } else if (run.log) {
    const auto& attachments = run.log->info().attachments;
    const auto found = attachments.find("scenario.resolved.yaml");
    if (found != attachments.end()) run.resolved_yaml = found->second;
  }
  if (run.resolved_yaml.empty()) return;
  run.scenario = scenario::parse_scenario(run.resolved_yaml, run.path, registry, {}, file.string());
  if (run.scenario->name != run.text("scenario")) {
    throw ConfigError(
        fmt::format("{}: is scenario '{}', but summary.json next to it belongs to '{}'",
                    file.string(), run.scenario->name, run.text("scenario")));
  }
  run.world = world_of(*run.scenario, registry, shelf);
  run.models = playback::vehicles_of_scenario(*run.scenario, registry);
}

}  // namespace

std::string RunFolder::text(const char* key) const {
  const auto found = summary.find(key);
  return found != summary.end() && found->is_string() ? found->get<std::string>() : "";
}

double RunFolder::number(const char* key) const {
  const auto found = summary.find(key);
  return found != summary.end() ? number_of(*found) : std::numeric_limits<double>::quiet_NaN();
}

double RunFolder::metric(const std::string& vehicle, const std::string& name) const {
  const auto metrics = summary.find("metrics");
  if (metrics == summary.end() || !metrics->is_object() || !metrics->contains(vehicle)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Json& of_vehicle = (*metrics)[vehicle];
  const auto found = of_vehicle.find(name);
  return found != of_vehicle.end() ? number_of(*found) : std::numeric_limits<double>::quiet_NaN();
}

double RunFolder::end_s() const {
  return number("simulated_s");
}

RunFolder read_run_folder(const fs::path& folder, const Registry& registry, RunShelf* shelf) {
  RunFolder run;
  run.path = folder;
  run.summary = read_summary(folder);
  open_log(run);
  read_scenario(run, registry, shelf);
  run.frames = files_in(folder / "frames", ".png");
  if (run.scenario) {
    for (const scenario::VehicleConfig& vehicle : run.scenario->vehicles) {
      run.vehicles.push_back(vehicle.name);
    }
  } else if (run.summary.contains("metrics")) {
    for (const auto& [name, metrics] : run.summary["metrics"].items()) run.vehicles.push_back(name);
  }
  return run;
}

std::vector<fs::path> files_in(const fs::path& folder, const char* extension) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

double number_of(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

const Json& list_in(const Json& json, const char* key) {
  static const Json none = Json::array();
  const auto found = json.find(key);
  return found != json.end() && found->is_array() ? *found : none;
}

}  // namespace vinerow::tools::report
