#include "engine/scenario/known_names.h"

#include <fmt/format.h>

#include "engine/core/suggest.h"

namespace vinerow::scenario {

std::string list_known(std::span<const std::string> names, std::size_t most) {
  if (names.empty()) return "none";
  if (names.size() <= most) return join(names);
  return fmt::format("{} and {} more", join(names.first(most)), names.size() - most);
}

}  // namespace vinerow::scenario
