#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/compare/compare_maps.h"
#include "tools/compare/compare_runs.h"
#include "tools/vinerow/number_checks.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

struct CompareArguments {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path geojson;
  bool json = false, all = false;
  double tolerance = 0.0, reach_m = 0.0;
  std::string fail_on = "none";
};

enum class FolderKind { kRun, kMap };

FolderKind kind_of_folder(const std::filesystem::path& folder) {
  if (std::filesystem::is_regular_file(folder / "summary.json")) return FolderKind::kRun;
  if (std::filesystem::is_regular_file(folder / "map.json")) return FolderKind::kMap;
  throw ConfigError(
      fmt::format("{}: contains neither summary.json nor map.json, so it is not the folder of a "
                  "run or of a map",
                  folder.string()));
}

int compare_run_folders(const CompareArguments& arguments) {
  if (!arguments.geojson.empty() || arguments.reach_m > 0.0) {
    throw ConfigError("compare: --geojson and --reach need two maps, but these are runs");
  }
  const RunComparison comparison = compare_runs(arguments.folders, arguments.tolerance);
  if (arguments.json) {
    fmt::print("{}\n", comparison_json(comparison).dump(1));
  } else {
    fmt::print("{}", comparison_text(comparison, arguments.all));
  }
  // Without --fail-on a difference is a result, not a failure.
  const bool worse = !comparison.regressions.empty();
  const bool other = worse || comparison.differences > 0;
  if (arguments.fail_on == "regression") return worse ? 1 : 0;
  return arguments.fail_on == "difference" && other ? 1 : 0;
}

int compare_map_folders(const CompareArguments& arguments) {
  if (arguments.folders.size() != 2) {
    throw ConfigError(fmt::format("compare: {} maps given, must be 2", arguments.folders.size()));
  }
  if (arguments.fail_on != "none" || arguments.tolerance > 0.0 || arguments.all) {
    throw ConfigError("compare: --fail-on, --tolerance and --all need runs, but these are maps");
  }
  const MapComparison comparison =
      compare_maps(arguments.folders[0], arguments.folders[1], arguments.reach_m);
  if (!arguments.geojson.empty()) {
    const std::string geojson = comparison_geojson(comparison);
    io::make_folder_of(arguments.geojson);
    write_whole_file(arguments.geojson, geojson);
  }
  if (arguments.json) {
    fmt::print("{}\n", comparison_json(comparison).dump(1));
  } else {
    fmt::print("{}", comparison_text(comparison));
    if (!arguments.geojson.empty()) fmt::print("geojson  {}\n", arguments.geojson.string());
  }
  return 0;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "compare runs by metrics and verdicts, or two maps row by row");
  command
      ->add_option("folders", arguments->folders,
                   "folders of runs, of which the first is the reference; or two folders of maps")
      ->required()
      ->expected(2, 1000);
  command->add_flag("--json", arguments->json, "as JSON");
  command->add_flag("--all", arguments->all, "runs: also print metrics that do not differ");
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "runs: metrics that differ by at most this fraction count as equal")
      ->check(within(0.0, 1.0));
  command
      ->add_option("--fail-on", arguments->fail_on,
                   "runs: exit with status 1 if a criterion or phase that the first run met is "
                   "not met (regression), or also if a metric differs (difference)")
      ->check(CLI::IsMember({"none", "regression", "difference"}))
      ->capture_default_str();
  command->add_option("--geojson", arguments->geojson,
                      "maps: write the rows and their changes to this file");
  command
      ->add_option("--reach", arguments->reach_m,
                   "maps: rows at most this far apart, m, are the same row (default: half the "
                   "row spacing)")
      ->check(positive());
  command->callback([arguments, &exit_status] {
    const FolderKind kind = kind_of_folder(arguments->folders.front());
    for (const std::filesystem::path& folder : arguments->folders) {
      if (kind_of_folder(folder) == kind) continue;
      throw ConfigError(
          fmt::format("compare: {} is the folder of a {}, but {} is the folder of a {}",
                      arguments->folders.front().string(), kind == FolderKind::kRun ? "run" : "map",
                      folder.string(), kind == FolderKind::kRun ? "map" : "run"));
    }
    exit_status = kind == FolderKind::kRun ? compare_run_folders(*arguments)
                                           : compare_map_folders(*arguments);
  });
}

}  // namespace vinerow::tools
