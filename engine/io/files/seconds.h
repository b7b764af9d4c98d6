#pragma once
/// Times as people and other programs read them.

#include "engine/core/time.h"

namespace vinerow::io {

/// The double nearest to the instant in s, which prints as 2.501. Time::s() is rounded twice
/// (2.5010000000000003); parts compute with it, and their digests depend on it.
constexpr double seconds(Time time) {
  return static_cast<double>(time.ns) / 1e9;
}
/// The double nearest to the span in s.
constexpr double seconds(Duration span) {
  return static_cast<double>(span.ns) / 1e9;
}

}  // namespace vinerow::io
