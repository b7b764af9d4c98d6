#include "engine/scenario/known_names.h"

#include <fmt/format.h>

#include "engine/core/suggest.h"

namespace vinerow::scenario {

std::string list_known(std::span<const std::string> names, std::size_t max_count) {
  if (names.empty()) return "none";
  if (names.size() <= max_count) return join(names);
  return fmt::format("{} and {} more", join(names.first(max_count)), names.size() - max_count);
}

}  // namespace vinerow::scenario
