#include "engine/ros2/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/core/error.h"

namespace vinerow::ros2 {
namespace {

// rmw limits topic names to 255 characters, of which prefix and suffix of the DDS name need 8.
constexpr std::size_t kMaxTopicLength = 247;
constexpr std::size_t kMaxNodeNameLength = 255;

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kLetters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";

bool is_identifier(std::string_view name) {
  return !name.empty() && kDigits.find(name.front()) == std::string_view::npos &&
         name.find_first_not_of(kLetters) == std::string_view::npos;
}

/// "/a/b", all parts identifiers.
bool is_full_name(std::string_view name) {
  if (!name.starts_with('/')) return false;
  while (!name.empty()) {
    name.remove_prefix(1);
    const std::size_t end = std::min(name.find('/'), name.size());
    if (!is_identifier(name.substr(0, end))) return false;
    name.remove_prefix(end);
  }
  return true;
}

}  // namespace

void check_node_name(std::string_view name) {
  if (is_identifier(name) && name.size() <= kMaxNodeNameLength) return;
  throw ConfigError(fmt::format(
      "node name '{}', must start with a letter or '_' and have at most {} letters, digits and '_'",
      name, kMaxNodeNameLength));
}

void check_name_space(std::string_view name_space) {
  if (name_space == "/" || (is_full_name(name_space) && name_space.size() <= kMaxTopicLength)) {
    return;
  }
  throw ConfigError(
      fmt::format("node namespace '{}', must be '/' or start with '/' and have at most {} letters, "
                  "digits, '_' and single '/'",
                  name_space, kMaxTopicLength));
}

void check_type_name(std::string_view type) {
  const std::size_t first = std::min(type.find('/'), type.size());
  const std::size_t second = std::min(type.find('/', first + 1), type.size());
  const std::string_view kind =
      second < type.size() ? type.substr(first + 1, second - first - 1) : std::string_view();
  constexpr std::array<std::string_view, 3> kKinds = {"msg", "srv", "action"};
  if (is_identifier(type.substr(0, first)) &&
      std::find(kKinds.begin(), kKinds.end(), kind) != kKinds.end() &&
      is_identifier(type.substr(second + 1))) {
    return;
  }
  throw ConfigError(
      fmt::format("message type '{}', must be package/msg/Type or package/srv/Type", type));
}

std::string resolve_name(std::string_view name, std::string_view name_space,
                         std::string_view node_name) {
  const std::string prefix(name_space == "/" ? std::string_view() : name_space);
  std::string full(name);
  if (name.starts_with("~/")) {
    full = fmt::format("{}/{}{}", prefix, node_name, name.substr(1));
  } else if (!name.starts_with('/')) {
    full = fmt::format("{}/{}", prefix, name);
  }
  if (is_full_name(full) && full.size() <= kMaxTopicLength) return full;
  throw ConfigError(
      fmt::format("topic '{}', must have at most {} letters, digits, '_' and single '/', and no "
                  "part that starts with a digit",
                  name, kMaxTopicLength));
}

std::string dds_type_name(std::string_view type) {
  check_type_name(type);
  const std::size_t first = type.find('/');
  const std::size_t second = type.find('/', first + 1);
  return fmt::format("{}::{}::dds_::{}_", type.substr(0, first),
                     type.substr(first + 1, second - first - 1), type.substr(second + 1));
}

}  // namespace vinerow::ros2
