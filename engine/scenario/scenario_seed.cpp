#include "engine/scenario/scenario_seed.h"

#include <fmt/format.h>

namespace vinerow::scenario {

Scenario with_seed(Scenario scenario, std::uint64_t seed) {
  scenario.seed = seed;
  // In the resolved text each key occurs once, and top-level keys are at the start of their lines.
  std::string& text = scenario.resolved_yaml;
  const std::string key = "\nseed: ";
  const std::size_t at = text.find(key);
  if (at != std::string::npos) {
    const std::size_t begin = at + key.size();
    text.replace(begin, text.find('\n', begin) - begin, std::to_string(seed));
  }
  return scenario;
}

std::string resolved_block(const Scenario& scenario, const std::string& key) {
  const std::string& text = scenario.resolved_yaml;
  const std::size_t begin = text.find("\n" + key + ":");
  if (begin == std::string::npos) return "";
  // The value of the key is indented.
  std::size_t end = text.find('\n', begin + 1);
  while (end != std::string::npos && end + 1 < text.size() && text[end + 1] == ' ') {
    end = text.find('\n', end + 1);
  }
  return text.substr(begin + 1, end - begin - 1);
}

}  // namespace vinerow::scenario
