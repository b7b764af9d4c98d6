#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/report/plot_files.h"
#include "tools/report/report.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

void write_plots(const std::filesystem::path& report, const std::filesystem::path& folder) {
  const std::vector<PlotFile> files = plot_files_of(read_bytes(report).value_or(""));
  io::make_folder(folder);
  for (const PlotFile& file : files) write_whole_file(folder / file.name, file.svg);
  fmt::print("{}  {} plots\n", folder.string(), files.size());
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    std::filesystem::path run, out, plots;
    std::vector<std::filesystem::path> plugins;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "report",
      "build the one-page HTML report of a run: verdicts, events, map, plots, pictures, replay");
  command->add_option("run", arguments->run, "folder of a run")->required();
  command->add_option("--out", arguments->out,
                      "page to write (default: report.html in the folder)");
  command->add_option("--plots", arguments->plots,
                      "folder for each plot and map as a separate file (SVG)");
  command
      ->add_option("--plugin", arguments->plugins,
                   "load a plug-in in addition to those the run names")
      ->allow_extra_args(false);
  command->callback([arguments, &exit_status] {
    if (!std::filesystem::is_directory(arguments->run)) {
      throw ConfigError(fmt::format("{}: is not a folder", arguments->run.string()));
    }
    const Registry registry = registry_of_run(arguments->run, arguments->plugins);
    const std::filesystem::path out =
        arguments->out.empty() ? arguments->run / "report.html" : arguments->out;
    write_report(arguments->run, registry, out);
    fmt::print("{}\n", out.string());
    if (!arguments->plots.empty()) write_plots(out, arguments->plots);
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
