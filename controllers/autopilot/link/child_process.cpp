#include "controllers/autopilot/link/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "engine/core/error.h"
#include "engine/core/program.h"

extern char** environ;

namespace vinerow::controllers {

ChildProcess::ChildProcess(std::vector<std::string> words, const std::filesystem::path& folder,
                           const std::string& who)
    : program_(words.front()), output_(folder / "output.txt") {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault) {
    throw ConfigError(
        fmt::format("{}: cannot make the folder {}: {}", who, folder.string(), fault.message()));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int failed =
      ::posix_spawnp(&process_, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0) {
    throw ConfigError(
        fmt::format("{}: '{}' cannot be started: {}", who, program_, std::strerror(failed)));
  }
}

ChildProcess::~ChildProcess() {
  if (!ending_.empty()) return;
  ::kill(-process_, SIGKILL);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::string ChildProcess::ending() {
  int status = 0;
  if (!ending_.empty() || ::waitpid(process_, &status, WNOHANG) != process_) return ending_;
  ending_ = WIFSIGNALED(status) ? fmt::format("was ended by signal {} ({})", WTERMSIG(status),
                                              ::strsignal(WTERMSIG(status)))
                                : fmt::format("ended with status {}", WEXITSTATUS(status));
  std::ifstream file(output_);
  const std::string said = last_line_of(std::string(std::istreambuf_iterator<char>(file), {}));
  if (!said.empty()) ending_ += fmt::format("; its last words: {}", said);
  return ending_;
}

}  // namespace vinerow::controllers
