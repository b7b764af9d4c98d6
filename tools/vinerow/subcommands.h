#pragma once
/// Sub-commands of `vinerow`. Each adds itself to the parser; its callback sets the exit status.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/run/run.h"
#include "engine/scenario/scenario.h"
#include "tools/vinerow/run_peers.h"

namespace vinerow::run {
class RunProfile;
}

namespace vinerow::tools {

/// Each adds one command. @param exit_status  set by the command when it has run
void add_run_command(CLI::App& app, int& exit_status);
void add_validate_command(CLI::App& app, int& exit_status);
void add_study_command(CLI::App& app, int& exit_status);
void add_list_command(CLI::App& app, int& exit_status);
void add_schema_command(CLI::App& app, int& exit_status);
void add_docs_command(CLI::App& app, int& exit_status);
void add_render_command(CLI::App& app, int& exit_status);
void add_info_command(CLI::App& app, int& exit_status);
void add_export_command(CLI::App& app, int& exit_status);
void add_compare_command(CLI::App& app, int& exit_status);
void add_video_command(CLI::App& app, int& exit_status);
void add_grid_command(CLI::App& app, int& exit_status);
void add_trim_command(CLI::App& app, int& exit_status);
void add_coverage_command(CLI::App& app, int& exit_status);
void add_survey_command(CLI::App& app, int& exit_status);
void add_cloud_command(CLI::App& app, int& exit_status);
void add_map_command(CLI::App& app, int& exit_status);
void add_replay_command(CLI::App& app, int& exit_status);
void add_dataset_command(CLI::App& app, int& exit_status);
void add_report_command(CLI::App& app, int& exit_status);

void add_completion_command(CLI::App& app, int& exit_status);

/// Options of every command that reads a scenario.
struct ScenarioArguments {
  std::filesystem::path file;
  scenario::Overrides overrides;
  std::vector<std::filesystem::path> plugins;
};
/// @param set_example  example in the help of --set, with a key that matters to this command
void add_scenario_arguments(CLI::App& command, ScenarioArguments& arguments,
                            const std::string& set_example);

/// Selection of the output of `vinerow run`.
struct RunChoice {
  std::filesystem::path out;  ///< empty: runs/<scenario name>
  bool no_log = false, no_pictures = false, no_report = false, quiet = false;
  run::RunProfile* profile = nullptr;  ///< to be written with the results; may be null
  PeerChoice peers;
};
/// Runs a scenario like `vinerow run`: progress, verdict, pictures, report. @returns the exit
/// status
run::RunStatus run_and_report(const scenario::Scenario& scenario, const Registry& registry,
                              const RunChoice& choice);

/// RUN/log.mcap for a folder, otherwise the file itself.
std::filesystem::path log_of(const std::filesystem::path& run_or_log);

/// Registry with the built-in parts and the parts of the plug-ins.
Registry make_registry(const std::vector<std::filesystem::path>& plugins);
/// The same for a run's folder or log, and the plug-ins that its resolved scenario names.
Registry registry_of_run(const std::filesystem::path& run_or_log,
                         const std::vector<std::filesystem::path>& plugins);
/// Loads plug-ins, then the scenario against them. @throws ConfigError
scenario::Scenario load(const ScenarioArguments& arguments, Registry& registry);

}  // namespace vinerow::tools
