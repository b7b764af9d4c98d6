#pragma once
/// The end of a vehicle: when and why it was wrecked, or is stuck.

#include <string>

#include "engine/core/time.h"

namespace vinerow {

struct Crash {
  std::string vehicle;
  Time time;
  std::string text;    ///< what Vehicle::crash() or ProgressWatch told
  bool stuck = false;  ///< whole, but it gets nowhere

  /// "drone crashed at 12.345 s: hit the ground at 2.3 m/s", "rover is stuck at 62.000 s: ..."
  std::string sentence() const;
};

}  // namespace vinerow
