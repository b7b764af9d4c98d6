#include "vinerow/session.h"

#include "engine/scenario/scenario.h"
#include "engine/sim/plugin_loader.h"
#include "tools/parts/register_all.h"

namespace vinerow {
namespace {

scenario::Overrides overrides_of(const ScenarioChanges& changes) {
  return {changes.sets, changes.seed};
}

}  // namespace

Session open_session(const std::filesystem::path& file, const ScenarioChanges& changes,
                     SessionOptions options) {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  const scenario::Overrides overrides = overrides_of(changes);
  for (const auto& plugin : scenario::load_plugin_list(file, overrides)) load_plugin(plugin, *registry);
  const scenario::Scenario scenario = scenario::load_scenario(file, *registry, overrides);
  return Session(scenario, std::move(registry), std::move(options));
}

Session open_session_text(const std::string& yaml, const std::filesystem::path& folder,
                          const ScenarioChanges& changes, SessionOptions options) {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  const scenario::Scenario scenario =
      scenario::parse_scenario(yaml, folder, *registry, overrides_of(changes));
  return Session(scenario, std::move(registry), std::move(options));
}

}  // namespace vinerow
