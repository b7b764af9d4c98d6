#include "tools/vinerow/video_encoder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/program.h"
#include "engine/core/whole_file.h"

extern char** environ;

namespace vinerow::tools {

VideoEncoder::VideoEncoder(std::filesystem::path out, double fps)
    : out_(std::move(out)), fps_(fps) {
  if (!has_program("ffmpeg")) {
    throw ConfigError(
        "no video: ffmpeg is not installed (Debian: apt-get install ffmpeg); 'vinerow render "
        "--from --to --every' draws the frames without it");
  }
  if (out_.extension().empty()) {
    throw ConfigError(fmt::format(
        "'{}': a video needs a file extension that gives its format, such as .mp4", out_.string()));
  }
  // ffmpeg derives the format from the extension, so the extension stays last.
  temporary_ = out_.parent_path() / fmt::format(".{}.{}.part{}", out_.stem().string(), ::getpid(),
                                                out_.extension().string());
  // A broken pipe is reported as an error; the signal would end the program.
  std::signal(SIGPIPE, SIG_IGN);
}

VideoEncoder::~VideoEncoder() {
  if (pipe_ >= 0) ::close(pipe_);
  if (process_ > 0) {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void VideoEncoder::start(int width, int height) {
  std::vector<std::string> words = {"ffmpeg",
                                    "-hide_banner",
                                    "-nostdin",
                                    "-loglevel",
                                    "error",
                                    "-y",
                                    "-f",
                                    "rawvideo",
                                    "-pixel_format",
                                    "rgb24",
                                    "-video_size",
                                    fmt::format("{}x{}", width, height),
                                    "-framerate",
                                    fmt::format("{}", fps_),
                                    "-i",
                                    "pipe:0"};
  const std::string ending = lower_extension(out_);
  if (ending == ".mp4" || ending == ".mov" || ending == ".mkv" || ending == ".webm") {
    // Every player shows this pixel format. It needs even sizes.
    words.insert(words.end(), {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"});
  }
  if (ending == ".mp4" || ending == ".mov") words.insert(words.end(), {"-movflags", "+faststart"});
  // The prefix keeps a name that begins with '-' from being read as an option.
  words.push_back("file:" + temporary_.string());

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw_cannot_write("'" + out_.string() + "'", errno);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int failed =
      ::posix_spawnp(&process_, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (failed != 0) {
    process_ = -1;
    throw ConfigError(
        fmt::format("no video: ffmpeg does not start: {}", words_of_write_failure(failed)));
  }
}

void VideoEncoder::add(const std::vector<std::uint8_t>& rgb, int width, int height) {
  if (process_ < 0) start(width, height);
  for (std::size_t done = 0; done < rgb.size();) {
    const ssize_t count = ::write(pipe_, rgb.data() + done, rgb.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      wait_for_success();
      throw WriteError(
          fmt::format("'{}' cannot be written: ffmpeg ended early, its messages are "
                      "above",
                      out_.string()));
    }
    done += static_cast<std::size_t>(count);
  }
}

bool VideoEncoder::wait_for_success() {
  if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void VideoEncoder::finish() {
  if (!wait_for_success()) {
    throw WriteError(fmt::format("'{}' cannot be written: ffmpeg failed, its messages are above",
                                 out_.string()));
  }
  std::error_code failed;
  std::filesystem::rename(temporary_, out_, failed);
  if (failed) throw_cannot_write("'" + out_.string() + "'", failed.value());
}

}  // namespace vinerow::tools
