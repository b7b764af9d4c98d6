#pragma once
/// Observer of a run, e.g. the writer of its log.

#include "engine/api/messages/event.h"
#include "engine/core/time.h"

namespace vinerow {

/// Observer of a run; it does not change the run.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// All signals of this instant are written; physics has not advanced yet.
  virtual void on_instant(Time /*now*/) {}
  /// The signal "run/events" has just been written.
  virtual void on_event(Time /*now*/, const Event& /*event*/) {}
};

}  // namespace vinerow
