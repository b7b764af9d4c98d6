#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/replay/replay_run.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {

void add_replay_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    std::filesystem::path run, out;
    std::vector<std::filesystem::path> plugins;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "replay", "write a page that shows a run in three dimensions, to orbit, scrub and follow");
  command->add_option("run", arguments->run, "folder of a run, or its log.mcap")->required();
  command->add_option("--out", arguments->out, "the page (default: replay.html beside the log)");
  command->add_option("--plugin", arguments->plugins, "load a plug-in that brought the run's parts")
      ->allow_extra_args(false);
  command->callback([arguments, &exit_status] {
    if (!has_replay()) throw ConfigError("no replay: " + replay_absence());
    const Registry registry = make_registry(arguments->plugins);
    const ReplayRun run = read_replay_run(arguments->run, registry);
    const std::string page = replay_page(run.input());
    const std::filesystem::path folder = std::filesystem::is_directory(arguments->run)
                                             ? arguments->run
                                             : arguments->run.parent_path();
    const std::filesystem::path out =
        arguments->out.empty() ? folder / "replay.html" : arguments->out;
    io::make_folder_of(out);
    write_whole_file(out, page);
    fmt::print("{}  {:.1f} MB\n", out.string(), 1e-6 * static_cast<double>(page.size()));
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
