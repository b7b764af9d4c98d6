#pragma once
/// What comes into a run from outside: which signals, and the values that wait for their instant.

#include <string>
#include <vector>

#include "engine/api/outside.h"

namespace vinerow {

class OutsideCommands {
 public:
  /// Claims the signals on the bus, before any part is built. @param bus  outlives this object
  /// @throws ConfigError where two claim one signal
  OutsideCommands(SignalBus& bus, const std::vector<OutsideSignal>& signals);

  /// Called when every part is connected. @throws ConfigError where no part reads such a signal
  void check_read() const;

  /// Keeps a value for the first instant that is not before its stamp.
  /// @param now  the next instant to be worked on
  /// @throws ConfigError on a signal that is not written from outside, another type, a stamp
  ///   before `now`, a value that is not a number
  void add(OutsideCommand command, Time now);

  /// Writes what is due, in the order of stamps, then of signals' names, then of coming in. Where
  /// several values of one signal are due, the last one counts.
  void deliver(Time now);

  bool empty() const { return signals_.empty(); }

 private:
  SignalBase& find(const SignalBase& value) const;

  SignalBus& bus_;
  std::vector<std::string> signals_;
  std::vector<OutsideCommand> waiting_;  ///< in the order of deliver()
};

}  // namespace vinerow
