#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/sim/pictures.h"
#include "tools/vinerow/commands.h"

namespace vinerow::tools {

void add_render_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    std::filesystem::path log, out;
    std::vector<std::filesystem::path> plugins;
    std::vector<double> times_s;
    double every_s = 0.0;
    int width = 0, height = 0;
    PictureOptions options;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("render", "draw frames from a log, without simulating again");
  command->add_option("log", arguments->log, "log.mcap of a run, complete or cut off")->required();
  command->add_option("--out", arguments->out,
                      "folder for the frames (default: frames beside the log)");
  command
      ->add_option("--camera", arguments->options.cameras,
                   "only this camera (may be given several times)")
      ->allow_extra_args(false);
  command
      ->add_option("--time", arguments->times_s,
                   "a frame at this simulated time, s (several times)")
      ->allow_extra_args(false);
  command->add_option("--every", arguments->every_s, "a frame every so many simulated seconds")
      ->check(CLI::PositiveNumber);
  command->add_option("--width", arguments->width, "pixels")->check(CLI::Range(16, 8192));
  command->add_option("--height", arguments->height, "pixels")->check(CLI::Range(16, 8192));
  command->add_option("--plugin", arguments->plugins, "load a plug-in that brought the run's parts")
      ->allow_extra_args(false);
  command->callback([arguments, &exit_status] {
    const Registry registry = make_registry(arguments->plugins);
    if (!arguments->times_s.empty()) arguments->options.times_s = arguments->times_s;
    if (arguments->every_s > 0.0) arguments->options.every_s = arguments->every_s;
    if (arguments->width > 0) arguments->options.width = arguments->width;
    if (arguments->height > 0) arguments->options.height = arguments->height;
    const std::filesystem::path out =
        arguments->out.empty() ? arguments->log.parent_path() / "frames" : arguments->out;
    const PictureReport report = render_log(arguments->log, out, registry, arguments->options);
    if (!report.write_failure.empty()) throw WriteError(report.write_failure);
    if (!report.note.empty()) throw ConfigError("no pictures: " + report.note);
    if (report.files.empty()) {
      throw ConfigError(
          fmt::format("no frame: none of the times lies within {}", arguments->log.string()));
    }
    for (std::size_t i = 0; i < report.files.size(); ++i) {
      fmt::print("{}  {}\n", report.digests[i], report.files[i].string());
    }
    fmt::print("{} frames, {:.0f} ms each\n", report.files.size(),
               report.files.empty()
                   ? 0.0
                   : 1e3 * report.wall_s / static_cast<double>(report.files.size()));
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
