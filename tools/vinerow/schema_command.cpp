#include <fmt/format.h>

#include "engine/scenario/study.h"
#include "tools/vinerow/subcommands.h"
#include "worlds/mapping/folder/map_json.h"

namespace vinerow::tools {

void add_schema_command(CLI::App& app, int& exit_status) {
  auto plugins = std::make_shared<std::vector<std::filesystem::path>>();
  auto of = std::make_shared<std::string>("scenario");
  CLI::App* command = app.add_subcommand(
      "schema", "print the JSON Schema of scenario files, study files, or the files of a map");
  command->add_option("of", *of, "scenario, study, or map.json or report.json of a map")
      ->capture_default_str()
      ->check(CLI::IsMember({"scenario", "study", "map.json", "report.json"}));
  command->add_option("--plugin", *plugins, "include the parts of a plug-in")
      ->allow_extra_args(false);
  command->callback([plugins, of, &exit_status] {
    fmt::print("{}\n", *of == "map.json"      ? mapping::map_json_schema()
                       : *of == "report.json" ? mapping::report_json_schema()
                       : *of == "study"       ? scenario::study_json_schema()
                                        : scenario::scenario_json_schema(make_registry(*plugins)));
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
