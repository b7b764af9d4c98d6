#pragma once
/// The end of a vehicle: when and why it was wrecked.

#include <string>

#include "engine/core/time.h"

namespace vinerow {

struct Crash {
  std::string vehicle;
  Time time;
  std::string text;  ///< what Vehicle::crash() told

  /// "drone crashed at 12.345 s: hit the ground at 2.3 m/s"
  std::string sentence() const;
};

}  // namespace vinerow
