#include <fmt/format.h>

#include "engine/run/run.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {

void add_validate_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    ScenarioArguments scenario;
    bool files_only = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("validate",
                                         "check a scenario like a run before its first step: "
                                         "files, values, wiring, metrics, plans");
  add_scenario_arguments(*command, arguments->scenario, "rover.controller.speed_mps=0.8");
  command->add_flag("--files-only", arguments->files_only,
                    "build no world and no vehicles, and so make no plans");
  command->callback([arguments, &exit_status] {
    Registry registry;
    const scenario::Scenario scenario = load(arguments->scenario, registry);
    if (!arguments->files_only) {
      for (const std::string& note : run::rehearse_run(scenario, registry)) {
        fmt::print("note: {}\n", note);
      }
    }
    fmt::print("{}: valid ({} vehicle{}, world '{}', {:g} s)\n", arguments->scenario.file.string(),
               scenario.vehicles.size(), scenario.vehicles.size() == 1 ? "" : "s",
               scenario.world.type, scenario.duration_s);
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
