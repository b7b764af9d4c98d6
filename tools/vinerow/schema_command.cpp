#include <fmt/format.h>

#include "tools/vinerow/commands.h"

namespace vinerow::tools {

void add_schema_command(CLI::App& app, int& exit_status) {
  auto plugins = std::make_shared<std::vector<std::filesystem::path>>();
  CLI::App* command = app.add_subcommand("schema", "print the JSON Schema of scenario files");
  command->add_option("--plugin", *plugins, "include the parts of a plug-in")
      ->allow_extra_args(false);
  command->callback([plugins, &exit_status] {
    fmt::print("{}\n", io::scenario_json_schema(make_registry(*plugins)));
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
