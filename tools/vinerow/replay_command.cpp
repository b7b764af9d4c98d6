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
      "replay",
      "write a web page that replays a run in 3D, with time slider, free and following cameras");
  command->add_option("run", arguments->run, "folder of a run, or its log.mcap")->required();
  command->add_option("--out", arguments->out,
                      "page to write (default: replay.html next to the log)");
  command
      ->add_option("--plugin", arguments->plugins,
                   "load a plug-in in addition to those the run names")
      ->allow_extra_args(false);
  command->callback([arguments, &exit_status] {
    if (!has_replay()) throw ConfigError("no replay: " + replay_absence());
    const Registry registry = registry_of_run(arguments->run, arguments->plugins);
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
