#pragma once
/// The end of a vehicle: when and why it was wrecked, or gave its task up.

#include <string>

#include "engine/core/time.h"

namespace vinerow {

struct Crash {
  std::string vehicle;
  Time time;
  std::string text;      ///< what Vehicle::crash() or MayFail::failure() told
  bool gave_up = false;  ///< its controller failed, and it is whole

  /// "drone crashed at 12.345 s: hit the ground at 2.3 m/s", "rover gave up at ..."
  std::string sentence() const;
};

}  // namespace vinerow
