#pragma once
/// A program that runs beside the simulation, with a folder of its own.

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace vinerow::controllers {

class ChildProcess {
 public:
  /// Starts it in its own process group, without input. Its output goes to "output.txt" in its
  /// folder, which is made.
  /// @param words  program and arguments; a program without "/" is searched for in PATH
  /// @param environment  "NAME=value", added to ours
  /// @param who    "rover.autopilot (ardupilot)", for errors
  /// @throws ConfigError if it cannot be started
  ChildProcess(std::vector<std::string> words, const std::vector<std::string>& environment,
               const std::filesystem::path& folder, const std::string& who);
  /// Ends it and what it has started. ArduPilot ignores polite signals while it waits.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;

  /// How it ended: "ended with status 1 (output.txt: ...)"; empty while it runs.
  std::string ending();

 private:
  std::string program_;
  std::filesystem::path output_;
  ::pid_t process_ = -1;
  std::string ending_;
};

}  // namespace vinerow::controllers
