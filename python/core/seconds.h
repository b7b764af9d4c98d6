#pragma once
/// Times as Python shows them.

#include "engine/core/time.h"

namespace vinerow::python {

/// The double nearest to the instant in s, so that Python prints 2.501. Time::s() is rounded twice
/// (2.5010000000000003). Parts in Python get that one: their digests are those of parts in C++.
inline double seconds(Time time) {
  return static_cast<double>(time.ns) / 1e9;
}

}  // namespace vinerow::python
