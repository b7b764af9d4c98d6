#include "tools/replay/replay_run.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/playback/run_frames.h"
#include "engine/sim/simulation.h"

namespace vinerow::tools {
namespace {

std::filesystem::path log_to_replay(const std::filesystem::path& run) {
  if (!std::filesystem::is_directory(run)) return run;
  const std::filesystem::path log = run / "log.mcap";
  if (!std::filesystem::exists(log)) {
    throw ConfigError(
        fmt::format("{}: contains no log.mcap, so there is nothing to replay", run.string()));
  }
  return log;
}

}  // namespace

std::vector<ReplayPhase> phases_of_summary(const std::string& summary,
                                           const std::filesystem::path& file, double last_s) {
  std::vector<ReplayPhase> phases;
  try {
    const nlohmann::json root = nlohmann::json::parse(summary);
    if (!root.contains("phases")) return phases;
    for (const nlohmann::json& entry : root.at("phases")) {
      const auto number = [&](const char* key, double absent) {
        return entry.contains(key) && entry.at(key).is_number() ? entry.at(key).get<double>()
                                                                : absent;
      };
      ReplayPhase phase;
      phase.name = entry.at("name").get<std::string>();
      phase.state = entry.value("state", "");
      phase.begin_s = number("begin_s", -1.0);
      if (phase.begin_s < 0.0 || phase.state == "not started") continue;
      phase.end_s = number("end_s", last_s);
      phases.push_back(std::move(phase));
    }
  } catch (const nlohmann::json::exception& error) {
    throw ConfigError(
        fmt::format("{}: its phases cannot be read: {}", file.string(), error.what()));
  }
  return phases;
}

ReplayRun read_replay_run(const std::filesystem::path& run, const Registry& registry) {
  const std::filesystem::path log = log_to_replay(run);
  ReplayRun result;
  result.scenario = playback::scenario_of_log(log, registry);
  result.world = build_world(result.scenario, registry);
  result.vehicles = playback::vehicles_of_scenario(result.scenario, registry);
  std::vector<std::string> names;
  for (const scenario::VehicleConfig& vehicle : result.scenario.vehicles)
    names.push_back(vehicle.name);
  result.trace = playback::read_trace(record::LogReader(log), names);
  const std::filesystem::path summary = log.parent_path() / "summary.json";
  if (const auto text = read_bytes(summary)) {
    result.phases = phases_of_summary(*text, summary, result.trace.last.s());
  }
  return result;
}

}  // namespace vinerow::tools
