#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/playback/coverage_log.h"
#include "tools/pictures/coverage_picture_files.h"
#include "tools/vinerow/number_checks.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

Polygon polygon_of(const std::vector<double>& numbers) {
  if (numbers.size() % 2 != 0) {
    throw ConfigError(
        fmt::format("--polygon: {} numbers, must be an even number: x and y of each corner in m",
                    numbers.size()));
  }
  Polygon polygon;
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    polygon.emplace_back(numbers[i], numbers[i + 1]);
  return polygon;
}

}  // namespace

void add_coverage_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    std::filesystem::path run, out;
    std::vector<std::filesystem::path> plugins;
    std::vector<double> polygon;
    double cell_m = 0.0;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "coverage", "map the ground that a survey's pictures cover, and their overlap, from its log");
  command->add_option("run", arguments->run, "folder of a run, or its log.mcap")->required();
  command->add_option("--out", arguments->out,
                      "picture to write, with the numbers next to it as .json (default: "
                      "coverage.png next to the log)");
  command->add_option(
      "--polygon", arguments->polygon,
      "parcel to use instead of the scenario's: x y of each corner in m, east and north of "
      "the origin");
  command->add_option("--cell", arguments->cell_m, "size of the cells, m")->check(positive());
  command
      ->add_option("--plugin", arguments->plugins,
                   "load a plug-in in addition to those the run names")
      ->allow_extra_args(false);
  command->callback([arguments, &exit_status] {
    const std::filesystem::path log = log_of(arguments->run);
    playback::CoverageChoice choice;
    choice.parcel_W = polygon_of(arguments->polygon);
    if (arguments->cell_m > 0.0) choice.cell_m = arguments->cell_m;
    const std::filesystem::path out =
        arguments->out.empty() ? log.parent_path() / "coverage.png" : arguments->out;
    const Registry registry = registry_of_run(arguments->run, arguments->plugins);
    const auto files = write_coverage(log, registry, choice, out);
    if (files.empty()) {
      throw ConfigError(fmt::format(
          "{}: contains no picture: no camera_trigger of the run took one", log.string()));
    }
    for (const std::filesystem::path& file : files) fmt::print("{}\n", file.string());
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
