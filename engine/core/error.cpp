#include "engine/core/error.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "engine/core/check.h"

namespace vinerow {

SimulationError::SimulationError(std::string culprit, Time time, const std::string& what)
    : std::runtime_error(fmt::format("t = {:.6f} s: {}: {}", time.s(), culprit, what)),
      culprit_(std::move(culprit)),
      time_(time) {}

namespace internal {

void check_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "vinerow: internal check failed: %s (%s:%d)\n", condition, file, line);
  std::abort();
}

}  // namespace internal
}  // namespace vinerow
