#include "engine/sim/crash.h"

#include <fmt/format.h>

namespace vinerow {

const char* to_string(EndKind kind) {
  switch (kind) {
    case EndKind::kStuck:
      return "is stuck";
    case EndKind::kGaveUp:
      return "gave up";
    case EndKind::kCrashed:
      break;
  }
  return "crashed";
}

std::string Crash::sentence() const {
  return fmt::format("{} {} at {:.3f} s: {}", vehicle, to_string(kind), time.s(), text);
}

}  // namespace vinerow
