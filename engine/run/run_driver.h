#pragma once
/// Control over a run from between its steps: a replay of commands, a live connection.

#include <cstdint>
#include <optional>

#include "engine/core/time.h"

namespace vinerow {
class Session;
}

namespace vinerow::run {

class RunDriver {
 public:
  virtual ~RunDriver() = default;

  /// What a run does next.
  struct Next {
    Time until;  ///< process the instants up to and including this one; before now(): none
    /// Start again at time 0 with this seed; `until` is then ignored.
    std::optional<std::uint64_t> restart_seed = std::nullopt;
  };

  /// The run is built, and its files are open. Called again after a restart.
  virtual void begin(Session& session) = 0;
  /// Called before every slice of the run. It may give commands, and may wait at most about 0.1 s,
  /// so that an interrupt is noticed.
  /// @param slice_end  end of the next slice if nobody decided otherwise
  /// @throws SimulationError to end the run
  virtual Next next(Session& session, Time slice_end) = 0;
  /// The run is over. `sentence` says why.
  virtual void end(Session& session) = 0;
};

}  // namespace vinerow::run
