#pragma once
/// Runs the command `vinerow` as a user would, in a process of its own.

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/paths.h"

namespace vinerow::test {

struct CommandResult {
  int status = -1;
  std::string output;  ///< stdout and stderr
};

/// @param environment  variables before the command, "NAME=value"
inline CommandResult run_vinerow(const std::string& arguments,
                                 const std::string& environment = "") {
  CommandResult result;
  const std::string command =
      environment + " " + std::string(VINEROW_BINARY_DIR) + "/bin/vinerow " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    result.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

/// A folder that is empty at the start and gone at the end of the test, of this process alone:
/// tests of one suite run side by side in processes of their own.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name)
      : path_(std::filesystem::path(VINEROW_BINARY_DIR) / "scratch" /
              (name + "_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::string scenario_file(const std::string& name) {
  return VINEROW_SOURCE_DIR "/assets/scenarios/" + name + ".yaml";
}

/// The line that starts with `key`, without it: digest_of(output, "digest").
inline std::string value_in(const std::string& output, const std::string& key) {
  const std::size_t at = output.find("\n" + key + " ");
  if (at == std::string::npos) return "";
  const std::size_t begin = output.find_first_not_of(' ', at + 1 + key.size());
  return output.substr(begin, output.find('\n', begin) - begin);
}

}  // namespace vinerow::test
