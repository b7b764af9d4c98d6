#pragma once
/// Data of a run for a replay, read from its folder.

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/world_model.h"
#include "tools/replay/replay.h"

namespace vinerow::tools {

struct ReplayRun {
  scenario::Scenario scenario;
  std::unique_ptr<WorldModel> world;
  std::vector<std::unique_ptr<Vehicle>> vehicles;  ///< order of the scenario's
  playback::LogTrace trace;
  std::vector<ReplayPhase> phases;

  ReplayInput input() const { return {&scenario, world.get(), &vehicles, &trace, phases}; }
};

/// Reads log.mcap and, if it exists, summary.json (phases).
/// @param run  a run's folder, or its log
/// @throws ConfigError "x: contains no log.mcap, ...", or as render_log(); "x/summary.json: ..." if
/// that is not JSON
ReplayRun read_replay_run(const std::filesystem::path& run, const Registry& registry);

/// Phases of a summary's "phases" that have started. One that did not end lasts until `last_s`.
/// @param summary  text of summary.json @param file  for messages
/// @throws ConfigError naming the file
std::vector<ReplayPhase> phases_of_summary(const std::string& summary,
                                           const std::filesystem::path& file, double last_s);

}  // namespace vinerow::tools
