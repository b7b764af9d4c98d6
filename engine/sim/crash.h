#pragma once
/// Failure of a vehicle: when and why it crashed, got stuck or gave up.

#include <string>

#include "engine/core/time.h"

namespace vinerow {

enum class EndKind {
  kCrashed,
  kStuck,   ///< undamaged, but it makes no progress
  kGaveUp,  ///< undamaged, but its guidance or controller cannot continue, or waits forever
};

/// "crashed", "is stuck", "gave up"
const char* to_string(EndKind kind);

struct Crash {
  std::string vehicle;
  Time time;
  std::string text;  ///< what Vehicle::crash(), ProgressWatch or MayFail::failure() reported
  EndKind kind = EndKind::kCrashed;

  /// "drone crashed at 12.345 s: hit the ground at 2.3 m/s", "rover is stuck at 62.000 s: ...",
  /// "rover gave up at ..."
  std::string sentence() const;
};

}  // namespace vinerow
