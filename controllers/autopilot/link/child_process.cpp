#include "controllers/autopilot/link/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "controllers/autopilot/link/plain_text.h"
#include "engine/core/error.h"
#include "engine/core/program.h"

extern char** environ;

namespace vinerow::controllers {

namespace {

/// Our variables with others, which replace those of the same name.
std::vector<std::string> merge_environment(const std::vector<std::string>& others) {
  const auto name_of = [](std::string_view variable) {
    return variable.substr(0, variable.find('='));
  };
  std::vector<std::string> all = others;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const bool is_replaced = std::any_of(others.begin(), others.end(), [&](const auto& other) {
      return name_of(other) == name_of(*variable);
    });
    if (!is_replaced) all.emplace_back(*variable);
  }
  return all;
}

/// As posix_spawn() takes them. @param texts  have to live as long as the result
std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> words,
                           const std::vector<std::string>& environment,
                           const std::filesystem::path& folder, const std::string& who)
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
  std::vector<std::string> variables = merge_environment(environment);
  const std::vector<char*> arguments = pointers_to(words);
  const int failed = ::posix_spawnp(&process_, arguments[0], &actions, &attributes,
                                    arguments.data(), pointers_to(variables).data());
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
  const std::string said =
      plain_text(last_line_of(std::string(std::istreambuf_iterator<char>(file), {})));
  if (!said.empty()) ending_ += fmt::format("; its last words: {}", said);
  return ending_;
}

}  // namespace vinerow::controllers
