#include "engine/sim/plugin_loader.h"
#include "tools/parts/register_all.h"
#include "tools/vinerow/commands.h"

namespace vinerow::tools {

void add_scenario_arguments(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("scenario", arguments.file, "scenario file (YAML)")->required();
  command.add_option(
      "--set", arguments.overrides.sets,
      "override a value, e.g. --set rover.controller.lookahead_m=0.5 (may be given several times)");
  command.add_option("--seed", arguments.overrides.seed, "seed of all random streams");
  command
      .add_option("--plugin", arguments.plugins, "load a plug-in beside those the scenario names")
      ->allow_extra_args(false);
}

std::filesystem::path log_of(const std::filesystem::path& run_or_log) {
  return std::filesystem::is_directory(run_or_log) ? run_or_log / "log.mcap" : run_or_log;
}

Registry make_registry(const std::vector<std::filesystem::path>& plugins) {
  Registry registry;
  register_all(registry);
  for (const auto& plugin : plugins) load_plugin(plugin, registry);
  return registry;
}

io::Scenario load(const ScenarioArguments& arguments, Registry& registry) {
  registry = make_registry(arguments.plugins);
  for (const auto& plugin : io::load_plugin_list(arguments.file, arguments.overrides))
    load_plugin(plugin, registry);
  return io::load_scenario(arguments.file, registry, arguments.overrides);
}

}  // namespace vinerow::tools
