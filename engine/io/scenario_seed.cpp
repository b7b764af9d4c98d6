#include "engine/io/scenario_seed.h"

#include <fmt/format.h>

namespace vinerow::io {

Scenario with_seed(Scenario scenario, std::uint64_t seed) {
  scenario.seed = seed;
  // The resolved text has every key once, each top-level one at the start of its line.
  std::string& text = scenario.resolved_yaml;
  const std::string key = "\nseed: ";
  const std::size_t at = text.find(key);
  if (at != std::string::npos) {
    const std::size_t begin = at + key.size();
    text.replace(begin, text.find('\n', begin) - begin, std::to_string(seed));
  }
  return scenario;
}

}  // namespace vinerow::io
