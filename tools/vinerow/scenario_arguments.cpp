#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

#include "engine/core/error.h"
#include "engine/io/files/yaml.h"
#include "engine/sim/plugin_loader.h"
#include "tools/parts/register_all.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

std::uint64_t read_seed(const std::string& text) {
  constexpr std::int64_t kLargest =
      std::numeric_limits<std::int64_t>::max();  // of a scenario's seed
  std::int64_t seed = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size() || seed < 0) {
    throw ConfigError(
        fmt::format("--seed = '{}', must be a whole number from 0 to {}", text, kLargest));
  }
  return static_cast<std::uint64_t>(seed);
}

/// Whether a plug-in is one of those given by --plugin, which are loaded already.
bool is_among(const std::vector<std::filesystem::path>& given,
              const std::filesystem::path& plugin) {
  std::error_code absent;  // said by who loads it
  return std::any_of(given.begin(), given.end(), [&](const std::filesystem::path& other) {
    return std::filesystem::equivalent(other, plugin, absent);
  });
}

}  // namespace

void add_scenario_arguments(CLI::App& command, ScenarioArguments& arguments,
                            const std::string& set_example) {
  command.add_option("scenario", arguments.file, "scenario file (YAML)")->required();
  command.add_option(
      "--set", arguments.overrides.sets,
      fmt::format("override a value, e.g. --set {} (may be given several times)", set_example));
  command.add_option_function<std::string>(
      "--seed",
      [&arguments](const std::string& text) { arguments.overrides.seed = read_seed(text); },
      "seed of all random streams, a whole number from 0");
  command
      .add_option("--plugin", arguments.plugins,
                  "load a plug-in in addition to those the scenario names")
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

Registry registry_of_run(const std::filesystem::path& run_or_log,
                         const std::vector<std::filesystem::path>& plugins) {
  Registry registry = make_registry(plugins);
  const std::filesystem::path scenario =
      log_of(run_or_log).parent_path() / "scenario.resolved.yaml";
  if (!std::filesystem::is_regular_file(scenario)) return registry;
  for (const auto& plugin : scenario::load_plugin_list(scenario)) {
    if (!is_among(plugins, plugin)) load_plugin(plugin, registry);
  }
  return registry;
}

scenario::Scenario load(const ScenarioArguments& arguments, Registry& registry) {
  registry = make_registry(arguments.plugins);
  scenario::Overrides overrides = arguments.overrides;
  io::YamlNode plugins = io::yaml_list();
  for (const auto& plugin : scenario::load_plugin_list(arguments.file, overrides)) {
    if (is_among(arguments.plugins, plugin)) continue;
    load_plugin(plugin, registry);
    plugins.items.push_back(io::yaml_text(plugin.string()));
  }
  for (const auto& plugin : arguments.plugins) {
    plugins.items.push_back(io::yaml_text(std::filesystem::absolute(plugin).string()));
  }
  // The resolved scenario names those of --plugin too, so it gives the same run without them.
  if (!arguments.plugins.empty()) overrides.sets.push_back("plugins=" + io::to_yaml(plugins));
  scenario::Scenario scenario = scenario::load_scenario(arguments.file, registry, overrides);
  for (const std::string& warning : scenario.warnings) {
    fmt::print(stderr, "vinerow: warning: {}\n", warning);
  }
  return scenario;
}

}  // namespace vinerow::tools
