#include "engine/sim/abi_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace vinerow {
namespace {

constexpr std::string_view kVersion = "vinerow-abi";

/// Fields of a tag, each "name value", in order. Empty if the text is not a valid tag.
std::vector<std::pair<std::string, std::string>> split_tag(std::string_view tag) {
  std::vector<std::pair<std::string, std::string>> fields;
  while (!tag.empty()) {
    const std::string_view field = tag.substr(0, tag.find("; "));
    tag.remove_prefix(std::min(tag.size(), field.size() + 2));
    const std::size_t space = field.find(' ');
    if (space == std::string_view::npos) return {};
    fields.emplace_back(field.substr(0, space), field.substr(space + 1));
  }
  if (fields.empty() || fields.front().first != kVersion) return {};
  return fields;
}

std::string describe_layout(const std::string& layout) {
  const std::size_t slash = layout.find('/');
  return fmt::format("{} bytes aligned to {}", layout.substr(0, slash),
                     slash == std::string::npos ? "?" : layout.substr(slash + 1));
}

/// Sentence about a field that differs. @param value, own  of plug-in and program
std::string explain(const std::string& name, const std::string& value, const std::string& own) {
  if (name == kVersion || name == "headers") {
    return fmt::format("was built for another version of vinerow's headers ({} {}, this one is {})",
                       name == kVersion ? "number" : "hash", value, own);
  }
  if (name == "alignment") {
    return fmt::format(
        "was compiled with {}-byte alignment (-mavx or -march=native?), this vinerow uses {}",
        value, own);
  }
  if (name == "ndebug") {
    return value == "1" ? "was compiled with NDEBUG, this vinerow without it"
                        : "was compiled without NDEBUG, this vinerow with it";
  }
  if (name == "cxx11_abi") {
    return fmt::format("was compiled with _GLIBCXX_USE_CXX11_ABI {}, this vinerow with {}", value,
                       own);
  }
  if (name == "gxx_abi") {
    return fmt::format("was compiled for C++ ABI {} (another compiler?), this vinerow for {}",
                       value, own);
  }
  return fmt::format("stores {} in {}, this vinerow in {} (other compiler flags?)", name,
                     describe_layout(value), describe_layout(own));
}

}  // namespace

std::string abi_difference(std::string_view plugin, std::string_view program) {
  if (plugin == program) return {};
  const auto own = split_tag(program);
  const auto others = split_tag(plugin);
  if (others.empty()) {
    return fmt::format("was built for '{}', this vinerow is '{} {}'", plugin, kVersion,
                       own.empty() ? "" : own.front().second);
  }
  const std::map<std::string, std::string> by_name(others.begin(), others.end());
  for (const auto& [name, value] : own) {
    const auto found = by_name.find(name);
    if (found == by_name.end()) return fmt::format("does not state its '{}'", name);
    if (found->second != value) return explain(name, found->second, value);
  }
  return fmt::format("states more than this vinerow expects ('{}')", plugin);
}

}  // namespace vinerow
