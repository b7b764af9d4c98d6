#pragma once
/// Signals that are written from outside a run, and a queue of their values.

#include <string>
#include <vector>

#include "engine/api/outside.h"

namespace vinerow {

class OutsideCommands {
 public:
  /// Claims the signals on the bus, before any part is built. @param bus  outlives this object
  /// @throws ConfigError if a signal is claimed twice
  OutsideCommands(SignalBus& bus, const std::vector<OutsideSignal>& signals);

  /// Call when every part is connected. Adds the signals that parts read from outside
  /// (Ports::read_from_outside). @throws ConfigError if no part reads one of the signals
  void close();

  /// Signals that programs outside the run may write, in the bus's order.
  const std::vector<std::string>& signals() const { return signals_; }

  /// Queues a value for the first instant at or after its stamp.
  /// @param now  the next instant to be processed
  /// @throws ConfigError on a signal that is not written from outside, another type, a stamp
  ///   before `now`, a value that is NaN
  void add(OutsideCommand command, Time now);

  /// Writes the values that are due, in order of stamp, then of signal name, then of arrival. If
  /// several values of one signal are due, the last one counts.
  void deliver(Time now);

 private:
  SignalBase& find(const SignalBase& value) const;

  SignalBus& bus_;
  std::vector<std::string> signals_;
  std::vector<OutsideCommand> waiting_;  ///< in the order of deliver()
};

}  // namespace vinerow
