#pragma once
/// Observers that write a run's log and its file of events.

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/record/recorder.h"
#include "engine/sim/run_observer.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::run {

/// Value of "end" in a log's result if the run went to its end, and if it broke off.
inline constexpr const char* kRunOver = "over";
inline constexpr const char* kRunBrokenOff = "broken off";

class LogObserver final : public RunObserver {
 public:
  /// @param simulation  outlives this object. @throws ConfigError if the file cannot be created
  LogObserver(const Simulation& simulation, const std::filesystem::path& file);

  void on_instant(Time now) override { recorder_.record(now); }
  /// Several events can fall into one instant; each is stored before the next overwrites it.
  void on_event(Time now, const Event&) override { recorder_.record(now); }

  /// Adds the result and closes the file. @param end  kRunOver or kRunBrokenOff
  /// @throws SimulationError if the log cannot be completed
  void finish(const Simulation& simulation, const std::string& end);

 private:
  record::Recorder recorder_;
};

class EventFile final : public RunObserver {
 public:
  /// @throws ConfigError, WriteError if the file cannot be created
  explicit EventFile(const std::filesystem::path& file);
  void on_event(Time now, const Event& event) override;

  /// @throws ConfigError, WriteError if a line is missing
  void check() const;

 private:
  std::string name_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, &std::fclose};
  off_t whole_bytes_ = 0;
  std::optional<int> error_number_;  ///< of the first line that could not be stored
};

}  // namespace vinerow::run
