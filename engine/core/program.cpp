#include "engine/core/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"

extern char** environ;

namespace vinerow {
namespace {

/// Unnamed file that is deleted when it is closed.
using ScratchFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

ScratchFile open_scratch_file() {
  return {std::tmpfile(), &std::fclose};
}

}  // namespace

bool has_program(const char* name) {
  const char* path = std::getenv("PATH");
  std::string_view rest = path ? path : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    if (::access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
    rest.remove_prefix(std::min(folder.size() + 1, rest.size()));
  }
  return false;
}

ProgramOutput run_program(std::vector<std::string> words) {
  // Files, not pipes: the program can write to both in any order without a concurrent reader.
  const ScratchFile output = open_scratch_file(), complaints = open_scratch_file();
  int failed = output && complaints ? 0 : errno;
  ::pid_t process = -1;
  if (failed == 0) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ::fileno(output.get()), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ::fileno(complaints.get()), STDERR_FILENO);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    failed = ::posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
  }
  if (failed != 0) {
    throw WriteError(
        fmt::format("{} does not start: {}", words.front(), words_of_write_failure(failed)));
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, read_from_start(output.get()),
          last_line_of(read_from_start(complaints.get()))};
}

std::string read_from_start(std::FILE* file) {
  std::rewind(file);
  std::string text;
  char block[4096];
  for (std::size_t count; (count = std::fread(block, 1, sizeof block, file)) > 0;) {
    text.append(block, count);
  }
  return text;
}

std::string last_line_of(std::string_view text) {
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string_view::npos) return "";
  text = text.substr(0, end + 1);
  const std::size_t begin = text.rfind('\n');
  return std::string(begin == std::string_view::npos ? text : text.substr(begin + 1));
}

}  // namespace vinerow
