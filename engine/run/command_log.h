#pragma once
/// Commands from outside, read from the log of an earlier run, and their replay.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/outside.h"
#include "engine/run/run_driver.h"

namespace vinerow::run {

/// What a log says about the commands that its run received.
struct CommandLog {
  std::filesystem::path file;
  std::vector<std::string> signals;      ///< written from outside
  std::vector<OutsideCommand> commands;  ///< by stamp, the instant at which each took effect
  std::optional<Time> stop_before;  ///< end of a run that broke off; absent: it went to its end
  std::string digest;               ///< "" if the run was killed
};

/// @throws ConfigError if the file is no log, is damaged, or a signal's type is one of a plug-in
CommandLog read_command_log(const std::filesystem::path& log);

/// Gives a run the commands of an earlier one at the same instants, and ends it at the same
/// instant.
class CommandReplay final : public RunDriver {
 public:
  explicit CommandReplay(CommandLog log) : log_(std::move(log)) {}

  /// @throws ConfigError if the run has other signals from outside than the log
  void begin(Session& session) override;
  /// @throws SimulationError at the last instant of a log whose run was ended from outside
  Next next(Session& session, Time slice_end) override;
  void end(Session&) override {}

  const CommandLog& log() const { return log_; }

 private:
  CommandLog log_;
  std::size_t next_ = 0;
};

}  // namespace vinerow::run
