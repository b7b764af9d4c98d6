#include "engine/scenario/scenario_override.h"

#include <fmt/format.h>

#include <charconv>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

std::vector<std::string> split_path(const std::string& path, const io::SourceMark& mark) {
  std::vector<std::string> keys;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = path.find('.', begin);
    keys.push_back(path.substr(begin, end - begin));
    if (keys.back().empty()) {
      io::fail_at(mark, fmt::format("the path '{}' has an empty key; write it like "
                                    "rover.controller.rate_Hz",
                                    path));
    }
    if (end == std::string::npos) return keys;
    begin = end + 1;
  }
}

/// Prepends `vehicles` if the path starts with a vehicle's name.
void complete_path(std::vector<std::string>& keys, const io::YamlNode& root,
                   const io::SourceMark& mark) {
  std::vector<std::string> known;
  for (const StructuralKey& key : scenario_keys()) {
    if (key.spec.name == keys.front()) return;
    known.push_back(key.spec.name);
  }
  if (const io::YamlNode* vehicles = root.find("vehicles")) {
    if (vehicles->has(keys.front())) {
      keys.insert(keys.begin(), "vehicles");
      return;
    }
    for (const io::YamlEntry& vehicle : vehicles->entries) known.push_back(vehicle.key);
  }
  io::fail_at(mark, fmt::format("unknown path '{}'{} (known: {})", keys.front(),
                                did_you_mean(keys.front(), known), join(known)));
}

io::YamlNode& list_item(io::YamlNode& list, const std::string& key, const std::string& path,
                        const io::SourceMark& mark) {
  std::size_t index = 0;
  const auto result = std::from_chars(key.data(), key.data() + key.size(), index);
  const bool whole = result.ec == std::errc() && result.ptr == key.data() + key.size();
  if (!whole || index >= list.items.size()) {
    io::fail_at(mark, list.items.empty()
                          ? fmt::format("{} is an empty list, which has no entry '{}'", path, key)
                          : fmt::format("{} is a list, its entries are 0 to {}, not '{}'", path,
                                        list.items.size() - 1, key));
  }
  return list.items[index];
}

void check_list_is_given(const io::YamlNode& mapping, const std::string& key,
                         const std::string& index, const std::string& path,
                         const io::SourceMark& mark) {
  const bool is_index = index.find_first_not_of("0123456789") == std::string::npos;
  if (!is_index || mapping.has(key)) return;
  io::fail_at(mark,
              fmt::format("{} is not given, so it has no entry {}; set the whole list: {}=[...]",
                          path, index, path));
}

void set_value(io::YamlNode& root, const std::vector<std::string>& keys, io::YamlNode value) {
  const io::SourceMark mark = value.mark;
  io::YamlNode* node = &root;
  std::string path;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const bool last = i + 1 == keys.size();
    if (node->is_list()) {
      node = &list_item(*node, keys[i], path, mark);
      path = join_path(path, keys[i]);
      if (last) *node = std::move(value);
      continue;
    }
    if (node->is_null()) {
      *node = io::yaml_mapping();
      node->mark = mark;
    }
    if (!node->is_mapping()) {
      io::fail_at(mark, fmt::format("{} = {} has no key '{}'", path, io::shown(*node), keys[i]));
    }
    // The source of the old value does not apply to the new one.
    if (last && keys[i] == "value" && is_sourced_value(*node)) node->erase("source");
    path = join_path(path, keys[i]);
    if (last && value.is_null()) {
      node->erase(keys[i]);
      return;
    }
    if (last) {
      // A key that is there keeps its place: the order of vehicles and sensors is that of their
      // steps.
      node->put(keys[i], std::move(value));
      return;
    }
    check_list_is_given(*node, keys[i], keys[i + 1], path, mark);
    if (!node->has(keys[i])) {
      io::YamlNode created = io::yaml_mapping();
      created.mark = mark;
      node->put(keys[i], std::move(created));
    }
    node = node->find(keys[i]);
  }
}

/// Calls `change` with every mark of a value.
template <class Change>
void change_marks(io::YamlNode& node, const Change& change) {
  change(node.mark);
  for (io::YamlNode& item : node.items) change_marks(item, change);
  for (io::YamlEntry& entry : node.entries) {
    change(entry.mark);
    change_marks(entry.value, change);
  }
}

/// @param value  with its marks
void apply_value(io::YamlNode& root, const std::string& path, io::YamlNode value) {
  change_marks(value, [](io::SourceMark& mark) { mark.is_override = true; });
  const io::SourceMark mark = value.mark;
  std::vector<std::string> keys = split_path(path, mark);
  complete_path(keys, root, mark);
  if (keys.back() == "include")
    io::fail_at(mark, "include cannot be set; name the file in the scenario");
  resolve_includes(value, "");
  set_value(root, keys, std::move(value));
}

void apply_set(io::YamlNode& root, const std::string& set, const std::filesystem::path& folder) {
  const io::SourceMark mark{fmt::format("--set {}", set), 0};
  const std::size_t equals = set.find('=');
  if (equals == std::string::npos || equals == 0) {
    io::fail_at(mark, "must have the form path=value, e.g. rover.controller.lookahead_m=0.5");
  }
  io::YamlNode value;
  try {
    value = io::parse_yaml(set.substr(equals + 1), mark.file, folder);
  } catch (const ConfigError&) {
    io::fail_at(mark, fmt::format("the value '{}' is not valid YAML", set.substr(equals + 1)));
  }
  change_marks(value, [&](io::SourceMark& of_value) { of_value = mark; });
  apply_value(root, set.substr(0, equals), std::move(value));
}

}  // namespace

void apply_overrides(io::YamlNode& root, const Overrides& overrides,
                     const std::filesystem::path& folder) {
  for (const OverrideValue& value : overrides.values) apply_value(root, value.path, value.value);
  for (const std::string& set : overrides.sets) apply_set(root, set, folder);
  if (overrides.seed) {
    io::YamlNode seed = io::yaml_text(std::to_string(*overrides.seed));
    seed.quoted = false;
    seed.mark = {"--seed", 0};
    root.put("seed", std::move(seed));
  }
}

}  // namespace vinerow::scenario
