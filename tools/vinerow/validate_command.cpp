#include <fmt/format.h>

#include "engine/api/world_model.h"
#include "engine/sim/simulation.h"
#include "tools/vinerow/commands.h"

namespace vinerow::tools {

void add_validate_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    ScenarioArguments scenario;
    bool files_only = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("validate", "check a scenario: files, values, wiring; nothing is run");
  add_scenario_arguments(*command, arguments->scenario);
  command->add_flag("--files-only", arguments->files_only,
                    "do not build the world and the vehicles");
  command->callback([arguments, &exit_status] {
    Registry registry;
    const io::Scenario scenario = load(arguments->scenario, registry);
    if (!arguments->files_only) {
      const Simulation simulation(scenario, registry);
      for (const std::string& note : simulation.world().notes) fmt::print("note: {}\n", note);
    }
    fmt::print("{}: valid ({} vehicle{}, world '{}', {:g} s)\n", arguments->scenario.file.string(),
               scenario.vehicles.size(), scenario.vehicles.size() == 1 ? "" : "s",
               scenario.world.type, scenario.duration_s);
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
