#pragma once
/// Number of seeds in tests of whole missions.

#include <cstdlib>

namespace vinerow::test {

/// @returns all seeds of a group where VINEROW_LONG_TESTS is set (.ci/nightly missions), else 1:
/// a group then costs seconds and still notices a mission that fails
inline int seeds_of_group(int all) {
  return std::getenv("VINEROW_LONG_TESTS") != nullptr ? all : 1;
}

}  // namespace vinerow::test
