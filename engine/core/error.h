#pragma once
/// Two exceptions for failures that a user can meet, each with its exit status
/// (docs/reference/exit_status.md).

#include <stdexcept>
#include <string>

#include "engine/core/time.h"

namespace vinerow {

/// Bad input: a file, parameter or name. Thrown while loading and building, never during a step.
/// The text is one sentence that names the place, the key, the value and what is allowed. Exit
/// status 2.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The simulation stopped: a non-finite state or a plug-in failure. Exit status 3.
class SimulationError : public std::runtime_error {
 public:
  /// @param culprit  failing part, e.g. "rover.controller (pure_pursuit)"
  /// @param what     what happened, without part and time
  SimulationError(std::string culprit, Time time, const std::string& what);

  const std::string& culprit() const { return culprit_; }
  Time time() const { return time_; }

 private:
  std::string culprit_;
  Time time_;
};

}  // namespace vinerow
