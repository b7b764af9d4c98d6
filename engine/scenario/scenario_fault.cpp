// Texts of error messages: allowed values, the key that was probably meant, the place where a
// misplaced key belongs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/suggest.h"
#include "engine/scenario/known_names.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/scenario_reader.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

/// Chosen: longer lists of known keys are hard to read.
constexpr std::size_t kMaxListedKeys = 40;

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return text;
}

/// "lookahead" of "lookahead_m": the key up to its last underscore.
std::string stem(const std::string& key) {
  const std::size_t underscore = key.rfind('_');
  return underscore == std::string::npos || underscore == 0 ? key : key.substr(0, underscore);
}

std::string range_text(const ParameterSpec& spec) {
  const char* above = spec.min_exclusive ? ">" : ">=";
  const bool has_min = std::isfinite(spec.min), has_max = std::isfinite(spec.max);
  if (has_min && has_max) return fmt::format(", {} {} and <= {}", above, spec.min, spec.max);
  if (has_min) return fmt::format(", {} {}", above, spec.min);
  if (has_max) return fmt::format(", <= {}", spec.max);
  return "";
}

/// Position of a mapping in the scenario, and its allowed keys.
struct Home {
  std::string path;
  std::vector<std::string> keys;
  std::vector<ParameterSpec> groups = {};  ///< mappings inside it
};

void add_part_home(const io::YamlNode* node, PartKind kind, const std::string& path,
                   const Registry& registry, std::vector<Home>& homes) {
  const io::YamlNode* type = node ? node->find("type") : nullptr;
  if (!type || !type->is_scalar()) return;
  const std::vector<std::string> known = registry.names(kind);
  if (std::find(known.begin(), known.end(), type->text) == known.end()) return;
  Home home{path, names_of(registry.spec(kind, type->text).parameters)};
  for (const ParameterSpec& spec : registry.spec(kind, type->text).parameters) {
    if (spec.kind == ParameterKind::kGroup) home.groups.push_back(spec);
  }
  homes.push_back(std::move(home));
}

/// All mappings of the scenario with fixed keys, in file order.
std::vector<Home> all_homes(const ReadContext& context) {
  std::vector<Home> homes;
  const io::YamlNode& root = context.root;
  std::vector<std::string> top;
  for (const StructuralKey& key : scenario_keys()) {
    top.push_back(key.spec.name);
    if (key.shape == KeyShape::kGroup) homes.push_back({key.spec.name, names_of(key.spec.fields)});
  }
  homes.push_back({"", top});
  add_part_home(root.find("world"), PartKind::kWorld, "world", context.registry, homes);
  const io::YamlNode* vehicles = root.find("vehicles");
  if (!vehicles) return homes;
  for (const io::YamlEntry& vehicle : vehicles->entries) {
    const std::string path = "vehicles." + vehicle.key;
    add_part_home(&vehicle.value, PartKind::kVehicle, path, context.registry, homes);
    std::vector<std::string> own;
    for (const StructuralKey& key : vehicle_keys()) {
      own.push_back(key.spec.name);
      const io::YamlNode* node = vehicle.value.find(key.spec.name);
      if (key.shape == KeyShape::kPart) {
        add_part_home(node, key.part_kind, path + "." + key.spec.name, context.registry, homes);
      } else if (key.shape == KeyShape::kNamedParts && node) {
        for (const io::YamlEntry& entry : node->entries) {
          add_part_home(&entry.value, key.part_kind, path + "." + key.spec.name + "." + entry.key,
                        context.registry, homes);
        }
      }
    }
    homes.push_back({path, own});
  }
  return homes;
}

bool contains(const std::vector<std::string>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Where a key of the mapping at `path` belongs: elsewhere, or in the only group of this mapping
/// that has it.
std::string belongs_hint(const std::string& key, const std::string& path,
                         const ReadContext& context) {
  const std::vector<Home> homes = all_homes(context);
  for (const Home& home : homes) {
    if (!contains(home.keys, key)) continue;
    return home.path.empty() ? "; it belongs at the top level" : "; it belongs to " + home.path;
  }
  std::string hint;
  for (const Home& home : homes) {
    if (home.path != path) continue;
    for (const ParameterSpec& group : home.groups) {
      if (!contains(names_of(group.fields), key)) continue;
      if (!hint.empty()) return "";
      hint = fmt::format("; it belongs to {}", join_path(path, group.name));
    }
  }
  return hint;
}

}  // namespace

std::string allowed_text(const ParameterSpec& spec) {
  const std::string unit = spec.unit.empty() ? "" : " in " + spec.unit;
  switch (spec.kind) {
    case ParameterKind::kNumber:
      return "a number" + unit + range_text(spec);
    case ParameterKind::kInteger:
      return "a whole number" + range_text(spec);
    case ParameterKind::kBoolean:
      return "true or false";
    case ParameterKind::kText:
      return spec.choices.empty() ? "a text" : "one of: " + join(spec.choices);
    case ParameterKind::kPath:
      return "the path of a file or folder";
    case ParameterKind::kNumberList:
      return spec.size > 0 ? fmt::format("a list of {} numbers{}", spec.size, unit)
                           : "a list of numbers" + unit;
    case ParameterKind::kTextList:
      return "a list of texts";
    case ParameterKind::kGroup:
      return fmt::format("a mapping with {}", join(names_of(spec.fields)));
    case ParameterKind::kGroupList:
      return fmt::format("a list of mappings with {}", join(names_of(spec.fields)));
  }
  return "";
}

std::string likely_key(const std::string& wrong, const std::vector<std::string>& known) {
  const std::string lower = lower_case(wrong);
  for (const std::string& key : known) {
    if (lower_case(key) == lower) return key;
  }
  // The unit is missing or different: among keys with the same stem, prefer the one that ends in a
  // unit.
  for (const std::string& begin : {lower, lower_case(stem(wrong))}) {
    std::vector<std::string> alike;
    for (const std::string& key : known) {
      if (stem(key) != key && lower_case(stem(key)) == begin) alike.push_back(key);
    }
    if (alike.empty()) continue;
    const std::string nearest = nearest_name(wrong, alike);
    return nearest.empty() ? alike.front() : nearest;
  }
  const std::string nearest = nearest_name(wrong, known);
  if (!nearest.empty() && edit_distance(wrong, nearest) <= 2) return nearest;
  for (const std::string& key : known) {
    // A word of the correct key: "rows" of "plant_rows".
    if (("_" + lower_case(key) + "_").find("_" + lower + "_") != std::string::npos) return key;
  }
  return nearest;
}

void check_keys(const io::YamlNode& mapping, const std::string& path,
                const std::vector<std::string>& known, const std::string& owner,
                const ReadContext* context) {
  for (const io::YamlEntry& entry : mapping.entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    std::vector<std::string> sorted = known;
    std::sort(sorted.begin(), sorted.end());
    std::string hint = context ? belongs_hint(entry.key, path, *context) : "";
    const std::string likely = likely_key(entry.key, sorted);
    if (hint.empty() && !likely.empty()) hint = fmt::format("; did you mean '{}'?", likely);
    io::fail_at(
        entry.mark,
        fmt::format("{}: unknown key{}{} (known: {})", join_path(path, entry.key),
                    owner.empty() ? "" : " of " + owner, hint, list_known(sorted, kMaxListedKeys)));
  }
}

void check_name(const io::YamlEntry& entry, const std::string& path, const char* what) {
  if (is_valid_name(entry.key)) return;
  io::fail_at(entry.mark,
              fmt::format("{}: the name of a {} is made of letters, digits, '_' and '-' and "
                          "starts with a letter or '_'",
                          join_path(path, entry.key), what));
}

void require_mapping(const io::YamlNode& node, const std::string& path,
                     const std::string& example) {
  if (!node.is_mapping()) {
    io::fail_at(node.mark,
                fmt::format("{} = {}, must be a mapping like {}", path, io::shown(node), example));
  }
}

}  // namespace vinerow::scenario
