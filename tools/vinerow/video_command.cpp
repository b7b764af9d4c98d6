#include <fmt/format.h>

#include <csignal>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/render/scene.h"
#include "tools/terminal/progress_line.h"
#include "tools/vinerow/number_checks.h"
#include "tools/vinerow/picture_arguments.h"
#include "tools/vinerow/subcommands.h"
#include "tools/vinerow/video_encoder.h"

namespace vinerow::tools {
namespace {

volatile std::sig_atomic_t video_interrupted = 0;

void note_video_interrupt(int) {
  video_interrupted = 1;
}

struct VideoArguments {
  std::filesystem::path out;
  double fps = 25.0, speed = 1.0;
  bool quiet = false;
  PictureArguments pictures;
};

/// @returns the exit status
int make_video(const VideoArguments& arguments) {
  const Registry registry = registry_of_run(arguments.pictures.log, arguments.pictures.plugins);
  const std::filesystem::path log = log_of(arguments.pictures.log);
  playback::PictureOptions options = picture_options(arguments.pictures);
  if (options.cameras.size() > 1) {
    throw ConfigError("video: --camera given several times, must be one camera");
  }
  if (options.cameras.empty()) {
    const scenario::Scenario scenario = playback::scenario_of_log(log, registry);
    const auto& cameras = scenario.pictures.cameras;
    options.cameras = {cameras.empty() ? "chase" : cameras.front().name};
  }
  options.every_s = arguments.speed / arguments.fps;
  const std::filesystem::path out = arguments.out.empty()
                                        ? log.parent_path() / (options.cameras.front() + ".mp4")
                                        : arguments.out;
  // Before any frame is drawn: the constructor throws if ffmpeg is not installed.
  VideoEncoder encoder(out, arguments.fps);
  io::make_folder_of(out);
  ProgressLine line(arguments.quiet);
  int frames = 0;
  options.take_frame = [&](const render::Image& image) {
    encoder.add(image.rgb, image.width, image.height);
    ++frames;
  };
  options.progress = [&line](int done, int total) { line.count("drawing frames", done, total); };
  options.interrupted = [] { return video_interrupted != 0; };
  std::signal(SIGINT, note_video_interrupt);
  const playback::PictureReport report = render_pictures(log, {}, registry, options);
  line.end();
  if (!report.write_failure.empty()) throw WriteError(report.write_failure);
  if (video_interrupted != 0) throw WriteError("interrupted: there is no video");
  if (!report.note.empty()) throw ConfigError("no video: " + report.note);
  if (frames == 0) throw ConfigError("no video: the camera has no frame in this time span");
  encoder.finish();
  fmt::print("{}  {} frames, {:g} s at {:g} frames per second{}\n", out.string(), frames,
             frames / arguments.fps, arguments.fps,
             arguments.speed == 1.0 ? "" : fmt::format(", {:g} times as fast", arguments.speed));
  return 0;
}

}  // namespace

void add_video_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<VideoArguments>();
  CLI::App* command =
      app.add_subcommand("video", "make a video from a log with ffmpeg, without simulating again");
  add_picture_arguments(*command, arguments->pictures);
  command->add_option(
      "-o,--out", arguments->out,
      "video to write: .mp4, .mkv, .webm, .gif (default: <camera>.mp4 next to the log)");
  command->add_option("--fps", arguments->fps, "frames per second of the video")
      ->check(within(1.0, 240.0))
      ->capture_default_str();
  command->add_option("--speed", arguments->speed, "simulated seconds per second of the video")
      ->check(within(0.01, 1000.0))
      ->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "show no progress");
  command->callback([arguments, &exit_status] { exit_status = make_video(*arguments); });
}

}  // namespace vinerow::tools
