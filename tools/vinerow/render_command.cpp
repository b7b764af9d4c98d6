#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "tools/report/html.h"
#include "tools/vinerow/number_checks.h"
#include "tools/vinerow/picture_arguments.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {

void add_render_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    std::filesystem::path out;
    std::vector<double> times_s;
    double every_s = 0.0;
    bool digest = false;
    PictureArguments pictures;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("render", "draw frames from a log, without simulating again");
  add_picture_arguments(*command, arguments->pictures);
  command->add_option("-o,--out", arguments->out,
                      "folder for the frames (default: frames next to the log)");
  command
      ->add_option("--time", arguments->times_s,
                   "draw a frame at this simulated time, s (may be given several times)")
      ->allow_extra_args(false);
  command->add_option("--every", arguments->every_s, "simulated seconds between frames")
      ->check(positive());
  command->add_flag("--digest", arguments->digest,
                    "print the MD5 sum of each frame's pixels before its name");
  command->callback([arguments, &exit_status] {
    const Registry registry = registry_of_run(arguments->pictures.log, arguments->pictures.plugins);
    playback::PictureOptions options = picture_options(arguments->pictures);
    if (!arguments->times_s.empty()) options.times_s = arguments->times_s;
    if (arguments->every_s > 0.0) options.every_s = arguments->every_s;
    const std::filesystem::path log = log_of(arguments->pictures.log);
    const std::filesystem::path out =
        arguments->out.empty() ? log.parent_path() / "frames" : arguments->out;
    const playback::PictureReport drawn = render_pictures(log, out, registry, options);
    if (!drawn.write_failure.empty()) throw WriteError(drawn.write_failure);
    if (!drawn.note.empty()) throw ConfigError("no pictures: " + drawn.note);
    if (drawn.files.empty()) {
      throw ConfigError(fmt::format("no frame: none of the times is within {}", log.string()));
    }
    for (std::size_t i = 0; i < drawn.files.size(); ++i) {
      fmt::print("{}{}\n", arguments->digest ? drawn.digests[i] + "  " : "",
                 drawn.files[i].string());
    }
    fmt::print("{}, {:.0f} ms each\n",
               report::counted(static_cast<long>(drawn.files.size()), "frame"),
               1e3 * drawn.wall_s / static_cast<double>(drawn.files.size()));
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
